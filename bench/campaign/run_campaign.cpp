#include "bench/campaign/run_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/campaign/bias.h"
#include "bench/campaign/environment.h"
#include "bench/campaign/file_lock.h"
#include "bench/campaign/measured_run.h"
#include "bench/campaign/pace.h"
#include "bench/campaign/run_settings.h"
#include "bench/campaign/scene_reference.h"
#include "bench/results/noise_floors.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "bench/results/within_folder.h"
#include "engine/inspect/path_classes.h"
#include "engine/load/load.h"
#include "engine/scene/hash_text.h"
#include "engine/session/render_clock.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// A campaign in one process. Its steps are described in the header.
class Campaign {
 public:
  Campaign(const CampaignSettings& settings, const CampaignHooks& hooks)
      : settings_(settings), hooks_(hooks), pace_(settings) {}

  bool run(const std::map<std::string, std::string>& keys) {
    if (!settings_.leftOut.empty()) hooks_.say(settings_.leftOut);
    // The folder may have come from others.
    for (const fs::path& name :
         {resultsFile(settings_).filename(), fs::path("images"), fs::path("references"), fs::path("checkpoints")}) {
      withinFolder(settings_.out, name);
    }
    // Opens or makes the results file. plan() throws where the campaign cannot run, so a new campaign makes its folder
    // only afterwards.
    if (fs::exists(resultsFile(settings_))) {
      lock_.emplace(resultsFile(settings_));
      store_.emplace(resultsFile(settings_));
      plan();
      createFolders();
      // Removes temporary files of a process that was killed while it wrote. Other shards may be writing theirs.
      if (settings_.shard.count == 1) {
        for (const char* name : {"images", "references", "checkpoints"}) {
          removeTemporariesIn((settings_.out / name).string());
        }
      }
    } else {
      plan();
      create();
    }
    // Stores what the campaign is, then runs scene by scene.
    store_->putCampaign(keys);
    store_->addEnvironment(environment(settings_.render));
    for (size_t s = 0; s < settings_.scenes.size(); ++s) {
      if (!runScene(settings_.scenes[s], methodsOfShard(settings_, s))) return false;
    }
    return true;
  }

 private:
  void createFolders() const {
    std::vector<const char*> names{"images", "references"};
    if (settings_.checkpoints) names.push_back("checkpoints");
    for (const char* name : names) {
      std::error_code error;
      fs::create_directories(settings_.out / name, error);
      if (!error) continue;
      throw ResultsFileError(fmt::format("{}: cannot be made: {}; expected a folder that takes new files",
                                         (settings_.out / name).string(), error.message()));
    }
  }

  // Makes folders, lock and results file of a new campaign.
  void create() {
    createFolders();
    const fs::path results = resultsFile(settings_);
    lock_.emplace(results);
    // Another process may have begun the campaign since run() looked.
    if (fs::exists(results)) {
      throw FileLockError(fmt::format("{}: another process has begun it; expected one at a time", results.string()));
    }
    store_.emplace(results);
  }

  // Nothing for a run that is not stored, and for all runs before the results file is open.
  std::optional<ResultsStore::KnownRun> knownRun(const CampaignScene& scene, const CampaignMethod& method,
                                                 uint64_t seed) {
    return store_ ? store_->findRun(scene.name, method.name(), seed) : std::nullopt;
  }
  // Whether a run is stored that was asked for at least the present time or iterations. A refused run without stats is
  // done: the method would be refused again. One with stats had no time for a whole image.
  bool isDone(const CampaignScene& scene, const CampaignMethod& method, uint64_t seed) {
    const std::optional<ResultsStore::KnownRun> run = knownRun(scene, method, seed);
    if (!run || (run->state == RunState::refused && run->stats.empty())) return run.has_value();
    try {
      const nlohmann::json stats = nlohmann::json::parse(run->stats);
      if (settings_.iterations) return stats.value("iterations", uint64_t{0}) >= *settings_.iterations;
      // Results files without the key say only how long the run took, which may be a little less than it was asked for.
      const auto asked = stats.find("asked_seconds");
      if (asked != stats.end()) return asked->get<double>() >= scene.effort.seconds;
      return stats.value("render_seconds", 0.0) >= 0.95 * scene.effort.seconds;
    } catch (const nlohmann::json::exception&) {
      throw ResultsFileError(
          fmt::format("{}: statistics of {} by {}, seed {}, are none; expected an intact results file",
                      resultsFile(settings_).string(), scene.name, method.name(), seed));
    }
  }
  // Counts the runs and references that are missing. Loads their scenes, so that a scene or reference that cannot be
  // used throws before the first run.
  void plan() {
    CampaignPlan plan;
    double ahead = 0;
    for (size_t s = 0; s < settings_.scenes.size(); ++s) {
      const CampaignScene& entry = settings_.scenes[s];
      const std::vector<CampaignMethod> methods = methodsOfShard(settings_, s);
      const size_t missing = missingRuns(entry, methods);
      plan.runs += methods.size() * settings_.seeds;
      plan.done += methods.size() * settings_.seeds - missing;
      if (missing == 0) {
        // Names of -D are those of all the campaign's scenes, of which a shard may have a few.
        if (methods.empty() && !settings_.definitions.empty()) load(entry);
        continue;
      }
      ahead += static_cast<double>(missing) * pace_.ofRun(entry);
      if (hasReference(entry)) continue;
      plan.unreferenced.push_back(entry.name);
      plan.referenceSeconds += pace_.ofReference(entry);
    }
    refuseUnusedDefinitions();
    // With counted iterations the plan has no seconds.
    if (!settings_.iterations) plan.renderSeconds = ahead;
    pace_.begin(plan, ahead + plan.referenceSeconds);
    if (settings_.iterations) plan.referenceSeconds = 0;
    if (hooks_.planned) hooks_.planned(plan);
  }

  // Throws LoadError for a name of -D that no scene uses. A scene that needs no loading may use any name.
  void refuseUnusedDefinitions() const {
    if (unused_.size() < settings_.scenes.size()) return;
    for (const auto& definition : settings_.definitions) {
      const std::string& name = definition.first;
      if (!std::ranges::all_of(unused_, [&](const auto& scene) { return scene.second.contains(name); })) continue;
      throw LoadError({settings_.scenes.front().file.string(), 0},
                      fmt::format("neither this scene nor another of the campaign uses -D {}; expected names of their "
                                  "variables",
                                  name));
    }
  }

  // The campaign's settings with the definitions that the scene uses. It has been loaded.
  CampaignSettings settingsOf(const CampaignScene& entry) const {
    CampaignSettings own = settings_;
    for (const std::string& name : unused_.at(entry.name)) own.definitions.erase(name);
    return own;
  }

  // Whether no reference has to be rendered for the scene. Throws if that of a known scene cannot be used.
  bool hasReference(const CampaignScene& entry) {
    const Scene scene = load(entry);
    if (!isKnown(entry, scene)) return referenceExists(scene, entry, settingsOf(entry));
    knownReference(entry);
    return true;
  }

  // Whether the scene was begun by an earlier process, which settled its reference. Throws if it has changed since.
  bool isKnown(const CampaignScene& entry, const Scene& scene) {
    const std::optional<std::string> known = store_ ? store_->sceneHash(entry.name) : std::nullopt;
    if (known && *known != hashText(scene.hash)) {
      throw ResultsFileError(fmt::format("{}: the scene changed since this campaign began; expected scene_hash {}",
                                         entry.file.string(), *known));
    }
    return known.has_value();
  }

  // The reference of a known scene. Throws if the file is none of it, or if runs of the scene were measured against
  // another one: references differ in their noise floors.
  Reference knownReference(const CampaignScene& entry) const {
    const fs::path file = settings_.out / referenceFile(entry.name);
    Reference found = readReference(file);
    const CampaignResults results = readResults(resultsFile(settings_));
    const SceneRecord* known = results.findScene(entry.name);
    std::string wrong = whyNoReference(found);
    if (wrong.empty() && known != nullptr &&
        (found.info.sceneHash != known->hash || found.mean.width != known->width ||
         found.mean.height != known->height)) {
      wrong = "is of another scene or size";
    }
    if (!wrong.empty()) {
      throw ResultsFileError(fmt::format("{}: {}; expected the reference of {}", file.string(), wrong, entry.name));
    }
    const bool measured = std::ranges::any_of(
        results.runs, [&](const RunRecord& run) { return run.scene == entry.name && !run.snapshots.empty(); });
    if (known != nullptr && measured && !sameFloors(known->noiseFloors, found.noiseFloors)) {
      throw ResultsFileError(fmt::format(
          "{}: has other noise floors than the reference that runs of {} were measured against; expected that "
          "one in its place, or another --out",
          file.string(), entry.name));
    }
    return found;
  }

  // Loads a scene in the size of the campaign, and notes which definitions it does not use. Meanwhile a signal may end
  // the process at once.
  Scene load(const CampaignScene& entry) {
    LoadOptions loading;
    loading.filmSize = settings_.size;
    loading.defines = settings_.definitions;
    std::set<std::string>& unused = unused_[entry.name];
    loading.unusedDefine = [&](const std::string& name) { unused.insert(name); };
    const IdleScope idle(hooks_.session);
    return loadScene(entry.file, loading);
  }

  bool stopped() const { return hooks_.stopped && hooks_.stopped(); }

  size_t missingRuns(const CampaignScene& entry, const std::vector<CampaignMethod>& methods) {
    size_t missing = 0;
    for (const CampaignMethod& method : methods) {
      for (uint64_t seed = 1; seed <= settings_.seeds; ++seed) missing += isDone(entry, method, seed) ? 0 : 1;
    }
    return missing;
  }

  // Renders the missing runs of a scene, then takes the errors of its methods apart. False: the campaign was stopped.
  bool runScene(const CampaignScene& entry, const std::vector<CampaignMethod>& methods) {
    if (methods.empty()) return true;
    // A scene without missing runs is not loaded.
    if (missingRuns(entry, methods) > 0) {
      const auto begin = Clock::now();
      const Scene scene = load(entry);
      const double loadSeconds = secondsSince(begin);
      const Reference reference = this->reference(entry, scene);
      if (stopped()) return false;
      const PreparedReference prepared(referenceFile(entry.name).string(), {reference.mean, Encoding::linear, {}});
      if (!runMissing(entry, scene, methods, prepared, reference, loadSeconds)) return false;
    }
    putBiases(entry, methods);
    return true;
  }

  // The reference of the scene. A scene that an earlier process began keeps its reference. Otherwise one is copied or
  // rendered, and the scene is stored with it.
  Reference reference(const CampaignScene& entry, const Scene& scene) {
    if (isKnown(entry, scene)) {
      Reference known = knownReference(entry);
      // Methods that are new to the campaign need verdicts on the path classes.
      putScene(entry, scene, known);
      return known;
    }
    const CampaignSettings own = settingsOf(entry);
    const bool exists = referenceExists(scene, entry, own);
    const auto begin = Clock::now();
    Reference reference = sceneReference(
        scene, entry, own, {.session = hooks_.session, .stopped = hooks_.stopped, .saveNow = {}, .advance = {}},
        hooks_.say);
    if (stopped()) return reference;
    if (!exists) pace_.finishReference(entry, secondsSince(begin));
    putScene(entry, scene, reference);
    return reference;
  }

  // Stores the scene with the facts of its reference and its path classes.
  void putScene(const CampaignScene& entry, const Scene& scene, const Reference& reference) {
    store_->putScene({.name = entry.name,
                      .hash = hashText(scene.hash),
                      .referenceFile = referenceFile(entry.name).string(),
                      .width = settings_.size[0],
                      .height = settings_.size[1],
                      .noiseFloors = reference.noiseFloors,
                      .pathClasses = pathClasses(scene)});
  }

  // What each of the campaign's methods makes of each class of the scene's paths.
  std::vector<PathClassRecord> pathClasses(const Scene& scene) const {
    const PathClassTable table = classifyPaths(scene);
    std::vector<PathClassRecord> records;
    for (const PathClass& entry : table.classes) {
      for (const CampaignMethod& method : settings_.methods) {
        const Verdict verdict = table.verdict(entry, method.method);
        records.push_back({entry.signature, method.name(), std::string(kVerdictNames[static_cast<size_t>(verdict)])});
      }
    }
    return records;
  }

  // Renders and stores each missing run. Seeds are the outer loop, so that changes of the machine meet all methods.
  // False: stopped.
  bool runMissing(const CampaignScene& entry, const Scene& scene, const std::vector<CampaignMethod>& methods,
                  const PreparedReference& prepared, const Reference& reference, double loadSeconds) {
    for (uint64_t seed = 1; seed <= settings_.seeds; ++seed) {
      for (const CampaignMethod& method : methods) {
        if (isDone(entry, method, seed)) continue;
        const auto begin = Clock::now();
        const std::optional<RunRecord> run =
            measuredRun({.scene = scene,
                         .settings = runSettings(settings_, entry, scene, method, seed),
                         .schedule = snapshotSchedule(settings_, entry),
                         .reference = prepared,
                         .halves = &reference,
                         .row = method.name(),
                         .out = settings_.out,
                         .keepImages = settings_.keepImages,
                         .checkpoint = checkpointFile(settings_, entry, method, seed),
                         .say = hooks_.say,
                         .loadSeconds = loadSeconds},
                        hooks_.session);
        if (!run) return false;
        store(*run, knownRun(entry, method, seed));
        const CampaignProgress& progress = pace_.finish(entry, secondsSince(begin));
        if (hooks_.finished) hooks_.finished(*run, progress);
        if (stopped()) return false;
      }
    }
    return true;
  }

  // Stores a run and its images; those of a shorter one that it replaces go once it is stored.
  void store(const RunRecord& run, const std::optional<ResultsStore::KnownRun>& shorter) {
    placeImages(settings_.out, run);
    if (!shorter) return store_->putRun(run);
    store_->replaceRun(run);
    for (const std::string& image : shorter->images) {
      const bool kept =
          std::ranges::any_of(run.snapshots, [&](const auto& snapshot) { return snapshot.file == image; });
      std::error_code ignored;  // of files that are gone already
      if (!kept) fs::remove(settings_.out / image, ignored);
    }
  }

  // Takes the error of each method apart into variance and bias, once all its seeds are done. Methods whose stored
  // result has as many seeds and the same last snapshot are skipped.
  void putBiases(const CampaignScene& entry, const std::vector<CampaignMethod>& methods) {
    if (settings_.seeds < 2) return;
    const CampaignResults results = readResults(resultsFile(settings_));
    std::optional<Reference> reference;  // once it is needed: a restored campaign may lack it
    for (const CampaignMethod& method : methods) {
      const std::string name = method.name();
      // The method's runs, and the last snapshot that all of them have.
      std::vector<const RunRecord*> runs;
      unsigned last = std::numeric_limits<unsigned>::max();
      for (const RunRecord& run : results.runs) {
        if (run.scene != entry.name || run.method != name || run.snapshots.empty()) continue;
        runs.push_back(&run);
        last = std::min(last, run.snapshots.back().number);
      }
      if (runs.size() < 2) continue;  // nothing to take apart
      const auto known = [&](const BiasRecord& bias) {
        return bias.scene == entry.name && bias.method == name && bias.seeds == runs.size() && bias.number == last;
      };
      if (std::any_of(results.biases.begin(), results.biases.end(), known)) continue;
      if (!reference) reference = knownReference(entry);
      store_->putBiases(measureBiases(runs, *reference));
    }
  }

  const CampaignSettings& settings_;
  const CampaignHooks& hooks_;
  std::optional<FileLock> lock_;
  std::optional<ResultsStore> store_;  // not before a new campaign is known to be able to begin
  Pace pace_;
  std::map<std::string, std::set<std::string>> unused_;  // of each scene that was loaded: names of -D without a use
};

}  // namespace

bool runCampaign(const CampaignSettings& settings, const std::map<std::string, std::string>& keys,
                 const CampaignHooks& hooks) {
  return Campaign(settings, hooks).run(keys);
}

}  // namespace wavecrest
