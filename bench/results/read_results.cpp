#include "bench/results/read_results.h"

#include <algorithm>
#include <set>

#include "bench/results/distinct_values.h"
#include "bench/results/noise_floors.h"
#include "bench/results/schema.h"
#include "bench/results/within_folder.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// ---- one file -------------------------------------------------------------------------------------------------------

// A path that is relative to the folder of the results file, resolved. An empty path stays empty. Throws
// ResultsFileError where the path leads out of the folder.
std::string resolved(const fs::path& results, const std::string& file) {
  return file.empty() ? file : withinFolder(results.parent_path(), file).lexically_normal().string();
}

std::map<std::string, std::string> readCampaign(Database& database) {
  std::map<std::string, std::string> values;
  Statement row(database, "SELECT key, value FROM campaign");
  while (row.step()) values[row.text(0)] = row.text(1);
  return values;
}

// Scenes in the order in which they were added, with noise floors and path classes.
std::vector<SceneRecord> readScenes(Database& database) {
  std::vector<SceneRecord> scenes;
  Statement row(database, "SELECT name, scene_hash, reference_file, width, height FROM scene ORDER BY rowid");
  Statement floor(database, "SELECT metric, value FROM noise_floor WHERE scene = ?");
  Statement pathClass(database, "SELECT class, method, verdict FROM path_class WHERE scene = ? ORDER BY rowid");
  while (row.step()) {
    SceneRecord scene{.name = row.text(0),
                      .hash = row.text(1),
                      .referenceFile = resolved(database.path(), row.text(2)),
                      .width = row.small(3),
                      .height = row.small(4)};
    floor.bind(scene.name);
    while (floor.step()) scene.noiseFloors[floor.text(0)] = floor.real(1);
    pathClass.bind(scene.name);
    while (pathClass.step()) scene.pathClasses.push_back({pathClass.text(0), pathClass.text(1), pathClass.text(2)});
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

// Reads the stages and the measured snapshots of the run with this id. A snapshot without a whole iteration shows a
// part of an image, and its scores are not those of the method: campaigns no longer keep any, and those of earlier ones
// are left out.
void readSnapshots(Database& database, int64_t id, RunRecord& run) {
  Statement stage(database, "SELECT name, items, seconds FROM stage WHERE run = ? ORDER BY position");
  stage.bind(id);
  while (stage.step()) run.stages.push_back({stage.text(0), stage.count(1), stage.real(2)});
  Statement row(database,
                "SELECT number, render_seconds, iterations, file FROM snapshot WHERE run = ? AND iterations > 0 "
                "ORDER BY number");
  Statement value(database, "SELECT metric, value FROM measurement WHERE run = ? AND number = ?");
  // Read the snapshots, each with its measurements.
  row.bind(id);
  while (row.step()) {
    SnapshotRecord snapshot{.number = row.small(0),
                            .renderSeconds = row.real(1),
                            .iterations = row.count(2),
                            .file = resolved(database.path(), row.text(3))};
    value.bind(id, snapshot.number);
    while (value.step()) snapshot.values[value.text(0)] = value.real(1);
    run.snapshots.push_back(std::move(snapshot));
  }
}

// Runs by scene in the order of scenes, then in the order in which they were added.
std::vector<RunRecord> readRuns(Database& database) {
  std::vector<RunRecord> runs;
  Statement row(
      database,
      "SELECT run.id, scene, method, seed, state, reason, stats FROM run JOIN scene ON scene.name = run.scene "
      "ORDER BY scene.rowid, run.id");
  while (row.step()) {
    RunRecord run{.scene = row.text(1),
                  .method = row.text(2),
                  .seed = row.count(3),
                  .state = row.text(4) == toString(RunState::done) ? RunState::done : RunState::refused,
                  .reason = row.text(5),
                  .stats = row.text(6)};
    readSnapshots(database, row.integer(0), run);
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<BiasRecord> readBiases(Database& database) {
  std::vector<BiasRecord> biases;
  Statement row(database,
                "SELECT scene, method, number, seeds, mean_square_error, variance, bias_squared FROM bias "
                "ORDER BY scene, method, number");
  while (row.step()) {
    biases.push_back({.scene = row.text(0),
                      .method = row.text(1),
                      .number = row.small(2),
                      .seeds = row.small(3),
                      .meanSquareError = row.real(4),
                      .variance = row.real(5),
                      .biasSquared = row.real(6)});
  }
  return biases;
}

std::vector<ClaimRecord> readClaims(Database& database) {
  std::vector<ClaimRecord> claims;
  // Files of the oldest version have no figures. An empty text stands for them.
  const std::string figure = hasClaimFigures(database) ? "figure" : "''";
  Statement row(database, "SELECT id, scene, statement, verdict, " + figure + ", evidence FROM claim ORDER BY rowid");
  while (row.step()) {
    claims.push_back({.id = row.text(0),
                      .scene = row.text(1),
                      .statement = row.text(2),
                      .verdict = row.text(3),
                      .figure = row.text(4),
                      .evidence = row.text(5)});
  }
  return claims;
}

// ---- several --------------------------------------------------------------------------------------------------------

// Keys of the campaign that may differ between the machines that share it; every other key must agree.
const std::set<std::string_view> kEnvironmentKeys{"commit",           "cpu",   "host",    "isa",
                                                  "reference_folder", "shard", "version", "threads"};

// Throws for a file that is no part of the campaign in the first file.
[[noreturn]] void fail(const fs::path& path, const std::string& wrong, const fs::path& first) {
  throw ResultsFileError(path.string() + ": " + wrong + "; expected another part of the campaign in " + first.string());
}

// Settings must agree. Facts of the environment may differ; then all distinct values are listed.
void mergeCampaign(CampaignResults& all, const CampaignResults& part, const fs::path& path, const fs::path& first) {
  for (const auto& [key, value] : part.campaign) {
    const auto [known, added] = all.campaign.try_emplace(key, value);
    if (added || known->second == value) continue;
    if (!kEnvironmentKeys.contains(key)) {
      fail(path,
           std::string("its ").append(key).append(" is '").append(value).append("', not '").append(known->second) + "'",
           first);
    }
    addDistinct(known->second, value);
  }
}

// Adds scenes that are new. A known one must have the same content, size and reference.
void mergeScenes(CampaignResults& all, const CampaignResults& part, const fs::path& path, const fs::path& first) {
  for (const SceneRecord& scene : part.scenes) {
    const SceneRecord* known = all.findScene(scene.name);
    if (known == nullptr) {
      all.scenes.push_back(scene);
    } else if (known->hash != scene.hash || known->width != scene.width || known->height != scene.height) {
      fail(path, "its scene " + scene.name + " is another", first);
    } else if (!sameFloors(known->noiseFloors, scene.noiseFloors)) {
      // References are compared by their noise floors, as the file paths may differ.
      fail(path, "its reference of " + scene.name + " is another", first);
    }
  }
}

// Adds runs, which must be new, and the biases.
void mergeRuns(CampaignResults& all, const CampaignResults& part, const fs::path& path, const fs::path& first) {
  for (const RunRecord& run : part.runs) {
    if (all.findRun(run.scene, run.method, run.seed) != nullptr) {
      fail(path, "repeats the run of " + run.method + " on " + run.scene + ", seed " + std::to_string(run.seed), first);
    }
    all.runs.push_back(run);
  }
  all.biases.insert(all.biases.end(), part.biases.begin(), part.biases.end());
}

// Orders the merged records. No part needs to know all scenes, so their common order is unknown: they go by name. The
// runs of a scene go together.
void sortParts(CampaignResults& all) {
  std::sort(all.scenes.begin(), all.scenes.end(),
            [](const SceneRecord& a, const SceneRecord& b) { return a.name < b.name; });
  std::stable_sort(all.runs.begin(), all.runs.end(),
                   [](const RunRecord& a, const RunRecord& b) { return a.scene < b.scene; });
  std::stable_sort(all.biases.begin(), all.biases.end(), [](const BiasRecord& a, const BiasRecord& b) {
    return std::tie(a.scene, a.method, a.number) < std::tie(b.scene, b.method, b.number);
  });
}

// The results files of shards in a folder, by name: results.1-of-4.sqlite, ...
std::vector<fs::path> shardFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results.") && name.ends_with(".sqlite") && name.find("-of-") != std::string::npos) {
      files.push_back(withinFolder(folder, name));
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

CampaignResults readResults(const fs::path& path) {
  const fs::path file = fs::is_directory(path) ? withinFolder(path, kResultsFile) : path;
  // A folder without a results file may have those of shards.
  if (fs::is_directory(path) && !fs::exists(file)) {
    if (const std::vector<fs::path> shards = shardFiles(path); !shards.empty()) return readResults(shards);
  }
  if (!fs::is_regular_file(file)) throw ResultsFileError(file.string() + ": does not exist; expected a results file");
  Database database(file, OpenFor::reading);
  requireSchema(database);
  // One transaction, so that a campaign under way is read at one moment.
  database.execute("BEGIN");
  return {.campaign = readCampaign(database),
          .scenes = readScenes(database),
          .runs = readRuns(database),
          .biases = readBiases(database),
          .claims = readClaims(database)};
}

bool holdsResults(const fs::path& folder) {
  return fs::is_directory(folder) && (fs::exists(folder / kResultsFile) || !shardFiles(folder).empty());
}

CampaignResults readResults(std::span<const fs::path> paths) {
  if (paths.empty()) throw std::invalid_argument("readResults: no file");
  CampaignResults all = readResults(paths.front());
  if (paths.size() == 1) return all;
  // The first part takes in the others. Each part could judge only its own runs, so verdicts are dropped.
  all.claims.clear();
  for (const fs::path& path : paths.subspan(1)) {
    const CampaignResults part = readResults(path);
    mergeCampaign(all, part, path, paths.front());
    mergeScenes(all, part, path, paths.front());
    mergeRuns(all, part, path, paths.front());
  }
  sortParts(all);
  return all;
}

}  // namespace wavecrest
