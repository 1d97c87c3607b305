#include "bench/report/collect_renders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "bench/image_attributes.h"
#include "bench/report/final_images.h"
#include "bench/report/method_style.h"
#include "bench/report/other_images.h"
#include "bench/report/results_folder.h"
#include "bench/report/run_series.h"
#include "bench/report/series_facts.h"
#include "bench/report/shown_metrics.h"
#include "bench/whole_number.h"
#include "metrics/image/image_io.h"
#include "metrics/noise_floor.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Keys of the stats that describe program and machine.
constexpr const char* kEnvironmentKeys[] = {"version", "commit", "cpu", "isa", "threads"};

struct SceneReference {
  PreparedReference image;
  std::vector<std::optional<double>> noiseFloors;  // by reportedMetrics()
  std::string origin;
};

constexpr const char* kHashKey = "scene_hash";
constexpr const char* kErrorKey = "relative_error";

// A value that the image says of itself; empty if it does not.
std::string attribute(const ImageFile& image, std::string_view key) { return attributeOf(image.metadata, key); }

// Throws if a file is of another scene than the runs. An empty hash is unknown and agrees with any.
void requireHash(const fs::path& file, const std::string& found, const std::string& ofRuns) {
  if (found.empty() || ofRuns.empty() || found == ofRuns) return;
  throw ResultsError(fmt::format("{}: is of scene_hash {}; expected {} as the renders", file.string(), found, ofRuns));
}

// The hash of the scene that all runs rendered; empty if none says it. Throws if two differ.
std::string commonHash(const std::vector<RunFile*>& runs) {
  std::string hash;
  for (const RunFile* run : runs) {
    requireHash(run->path, run->sceneHash, hash);
    if (hash.empty()) hash = run->sceneHash;
  }
  return hash;
}

// Throws unless the metadata have the scene hash and the relative error that `wavecrest reference` writes.
void requireReference(const fs::path& file, const ImageFile& image) {
  const bool said = !attribute(image, kHashKey).empty() && !attribute(image, kErrorKey).empty();
  if (said) return;
  throw ResultsError(
      fmt::format("{}: is a plain image, without the two halves of a reference; expected one made by "
                  "`wavecrest reference`, or two independent renders",
                  file.string()));
}

// Throws if both halves name the same seed: then their errors are not independent.
void requireIndependent(const fs::path& second, const ImageFile& a, const ImageFile& b) {
  const std::string seed = attribute(a, "seed");
  if (seed.empty() || seed != attribute(b, "seed")) return;
  throw ResultsError(
      fmt::format("{}: has the seed {} of the other half; expected another seed", second.string(), seed));
}

// Reads the noise floors that a whole reference stores. A floor that is absent or not finite stays empty.
void readFloors(const fs::path& file, const ImageFile& image, std::vector<std::optional<double>>& floors) {
  const std::vector<const Metric*> metrics = reportedMetrics();
  for (size_t m = 0; m < metrics.size(); ++m) {
    const std::string text = attribute(image, std::string(kNoiseFloorKey) + scoreName(*metrics[m], metrics[m]->score));
    if (text.empty()) continue;
    const std::optional<double> value = wholeNumber<double>(text);
    if (!value) throw ResultsError(fmt::format("{}: noise floor '{}'; expected a number", file.string(), text));
    if (std::isfinite(*value)) floors[m] = *value;
  }
}

// The reference of a scene with the noise floor of each reported metric. Throws ResultsError if the file or the halves
// are not fit to be one.
// plain: whether it may be an image that says nothing of its noise.
SceneReference readReference(const std::vector<fs::path>& files, const std::string& hashOfRuns, bool plain) {
  const std::vector<const Metric*> metrics = reportedMetrics();
  std::vector<std::optional<double>> floors(metrics.size());
  ImageFile mean = readImage(files[0].string());
  std::string origin = files[0].filename().string();
  requireHash(files[0], attribute(mean, kHashKey), hashOfRuns);
  // A file of `wavecrest reference` is the mean already and stores the floors. Two halves are averaged, and their
  // difference gives the floors.
  if (files.size() == 1) {
    if (plain && attribute(mean, kErrorKey).empty()) {
      origin += ", an image that does not say how noisy it is";
    } else {
      requireReference(files[0], mean);
    }
    readFloors(files[0], mean, floors);
  } else {
    const PreparedReference first(files[0].string(), mean);
    // Refuses another size, naming both files.
    const ComparedImage second = first.prepareTest(files[1].string(), readImage(files[1].string()));
    requireHash(files[1], attribute(second.file, kHashKey), hashOfRuns);
    requireIndependent(files[1], mean, second.file);
    // Measure the floors first: `a` is the buffer that the mean overwrites.
    const Image &a = mean.image, &b = second.file.image;
    for (const NoiseFloor& floor : noiseFloors(a, b, metricList())) {
      for (size_t m = 0; m < metrics.size(); ++m) {
        if (metrics[m]->name == floor.metric && std::isfinite(floor.score)) floors[m] = floor.score;
      }
    }
    for (size_t i = 0; i < mean.image.pixels.size(); ++i) mean.image.pixels[i] = 0.5F * (a.pixels[i] + b.pixels[i]);
    origin = fmt::format("mean of {} and {}, two independent halves", origin, files[1].filename().string());
  }
  return {PreparedReference(files[0].string(), std::move(mean)), std::move(floors), std::move(origin)};
}

// Adds a remark where pixels are not finite. images: which ones they belong to.
void addNonFiniteRemark(std::vector<std::string>& remarks, const std::string& scene, uint64_t pixels,
                        const std::string& images) {
  if (pixels == 0) return;
  remarks.push_back(fmt::format("{}: {} pixels of {} are not finite; scores leave them out.", scene, pixels, images));
}

// Measures one snapshot. A metric that needs a larger image gets NaN; scores besides the main one go into `further`.
// Adds the pixels that are finite in the reference alone to nonFinitePixels.
ReportPoint measure(const SnapshotFile& snapshot, const PreparedReference& reference, uint64_t& nonFinitePixels) {
  ReportPoint point{
      .number = snapshot.number, .seconds = snapshot.seconds, .iterations = snapshot.iterations, .values = {}};
  const std::string path = snapshot.image.string();
  const ComparedImage image = reference.prepareTest(path, readImage(path));
  nonFinitePixels += image.nonFinitePixels - reference.image().nonFinitePixels;
  for (const Metric* metric : reportedMetrics()) {
    if (std::min(image.codes.width, image.codes.height) < metric->smallestSide) {
      point.values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const Measurement measurement = metric->measure(reference, image, false);
    point.values.push_back(mainScore(*metric, measurement));
    for (const Score& score : measurement.scores) {
      if (score.name != metric->score) point.further.push_back({scoreName(*metric, score.name), score.value});
    }
  }
  return point;
}

// Adds the stages of one run. Entries of another form than render --stats writes are skipped.
void addStages(std::vector<ReportStage>& sums, const nlohmann::json& stats) {
  const auto stages = stats.find("stages");
  if (stages == stats.end() || !stages->is_array()) return;
  for (const nlohmann::json& stage : *stages) {
    if (!stage.is_object()) continue;
    const auto name = stage.find("name"), items = stage.find("items"), seconds = stage.find("seconds");
    if (name == stage.end() || !name->is_string()) continue;
    addStage(sums, {.name = name->get<std::string>(),
                    .items = items != stage.end() && items->is_number() ? items->get<uint64_t>() : 0,
                    .seconds = seconds != stage.end() && seconds->is_number() ? seconds->get<double>() : 0});
  }
}

// Measures all runs of a group and sums up what they cost. Adds to the report's remarks.
ReportSeries collectSeries(const std::vector<RunFile*>& runs, const std::string& label,
                           const PreparedReference& reference, std::vector<std::string>& remarks) {
  ReportSeries series;
  series.method = methodId(runs.front()->method);
  series.label = label;
  std::vector<const nlohmann::json*> stats;
  uint64_t nonFinitePixels = 0;
  for (const RunFile* run : runs) {
    ReportRun measured{.seed = run->seed, .points = {}};
    for (const SnapshotFile& snapshot : run->snapshots) {
      measured.points.push_back(measure(snapshot, reference, nonFinitePixels));
    }
    series.runs.push_back(std::move(measured));
    stats.push_back(&run->stats);
    addStages(series.stages, run->stats);
  }
  addSeriesFacts(series, stats);
  addNonFiniteRemark(remarks, runs.front()->scene, nonFinitePixels, "images of " + label);
  return series;
}

// Where runs and references come from.
struct RenderFolder {
  fs::path folder;
  fs::path list;       // of images of other programs; need not exist
  fs::path reference;  // of all scenes; empty: those in the folder
};

// Runs with stats files, then images of other programs.
std::vector<RunFile> readAllRuns(const RenderFolder& from) {
  std::vector<RunFile> runs = readRuns(from.folder);
  // Images that do not say their scene are of the only one.
  std::string scene = runs.empty() ? sceneOfFolder(from.folder) : runs.front().scene;
  const bool several = std::ranges::any_of(runs, [&](const RunFile& run) { return run.scene != scene; });
  const std::vector<RunFile> others = fs::is_regular_file(from.list)
                                          ? readListedRuns(from.list, several ? "" : scene)
                                          : readNamedRuns(from.folder, several ? "" : scene, runs);
  for (const RunFile& other : others) {
    if (!other.scene.empty()) continue;
    throw ResultsError(
        fmt::format("{}: of which scene is open, as the folder has several; expected a column 'scene' in {}",
                    other.path.string(), kImageList));
  }
  runs.insert(runs.end(), others.begin(), others.end());
  if (!runs.empty()) return runs;
  throw ResultsError(
      fmt::format("{}: holds nothing to report; expected results of converge, stats files of render --stats, or images "
                  "METHOD.SECONDS.exr",
                  from.folder.string()));
}

// One scene with all its runs, of which there is at least one. Adds to the report's remarks.
ReportScene collectScene(const RenderFolder& from, const std::string& name, const std::vector<RunFile*>& runs,
                         std::vector<std::string>& remarks) {
  ReportScene scene;
  scene.name = name;
  const bool given = !from.reference.empty();
  const bool anyOther = std::ranges::any_of(runs, [](const RunFile* run) { return run->other; });
  const SceneReference reference = readReference(given ? std::vector{from.reference} : findReference(from.folder, name),
                                                 commonHash(runs), given || anyOther);
  scene.width = reference.image.image().codes.width;
  scene.height = reference.image.image().codes.height;
  scene.referenceOrigin = reference.origin;
  scene.noiseFloors = reference.noiseFloors;
  addNonFiniteRemark(remarks, name, reference.image.image().nonFinitePixels, "the reference");
  // Each series shows images of its first run.
  std::vector<std::vector<TimedImage>> images;
  const auto groups = groupBySettings(runs);
  for (const auto& group : groups) {
    const std::string label = seriesLabel(groups, *group[0]);
    numberSnapshots(group);
    if (std::string remark = remarkOnEnds(group, label); !remark.empty()) remarks.push_back(std::move(remark));
    scene.series.push_back(collectSeries(group, label, reference.image, remarks));
    auto& run = images.emplace_back();
    for (const SnapshotFile& snapshot : group[0]->snapshots) run.push_back({snapshot.seconds, snapshot.image});
  }
  addChainsRemark(remarks, scene);
  addImages(scene, reference.image, images);
  return scene;
}

}  // namespace

ConvergenceReport collectRenders(const fs::path& path, const fs::path& givenReference) {
  const bool isList = path.extension() == ".csv";
  // The folder of a name without one is the current one.
  const fs::path besideList = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const RenderFolder from{
      .folder = isList ? besideList : path, .list = isList ? path : path / kImageList, .reference = givenReference};
  std::vector<RunFile> files = readAllRuns(from);
  // List the scenes in order of first appearance.
  std::vector<const nlohmann::json*> stats;
  std::vector<std::string> scenes;
  for (const RunFile& file : files) {
    stats.push_back(&file.stats);
    if (std::find(scenes.begin(), scenes.end(), file.scene) == scenes.end()) scenes.push_back(file.scene);
  }

  // Describe the page, then collect scene by scene.
  ConvergenceReport report;
  report.title =
      scenes.size() == 1 ? "Convergence of " + scenes[0] : fmt::format("Convergence on {} scenes", scenes.size());
  for (const Metric* metric : reportedMetrics()) report.metrics.push_back(shownMetric(*metric));
  for (const char* key : kEnvironmentKeys) addDistinct(report.environment, stats, key);
  for (const std::string& scene : scenes) {
    std::vector<RunFile*> runs;
    for (RunFile& file : files) {
      if (file.scene == scene) runs.push_back(&file);
    }
    report.scenes.push_back(collectScene(from, scene, runs, report.remarks));
  }
  return report;
}

}  // namespace wavecrest
