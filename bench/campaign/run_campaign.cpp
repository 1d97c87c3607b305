#include "bench/campaign/run_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/campaign/bias.h"
#include "bench/campaign/environment.h"
#include "bench/campaign/measured_run.h"
#include "bench/campaign/scene_reference.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "engine/load/load.h"
#include "engine/path_classes.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string hashOf(const Scene& scene) { return fmt::format("{:016x}", scene.hash); }

// The methods of a scene that this shard does.
std::vector<Method> methodsOfShard(const CampaignSettings& settings, size_t scene) {
  std::vector<Method> methods;
  for (size_t i = 0; i < settings.methods.size(); ++i) {
    const size_t group = scene * settings.methods.size() + i;
    if (group % settings.shard.count == settings.shard.index - 1) methods.push_back(settings.methods[i]);
  }
  return methods;
}

// Guesses how long the rest takes: its render time, and what runs so far took beyond theirs. Time is counted in render
// seconds, or in runs of counted iterations, which are taken for equally long.
class Pace {
 public:
  explicit Pace(const CampaignSettings& settings) : settings_(settings) {}

  double ofRun(const CampaignScene& scene) const { return settings_.iterations ? 1 : scene.effort.seconds; }
  double ofReference(const CampaignScene& scene) const { return kReferenceEffort * ofRun(scene); }

  void begin(const CampaignPlan& plan, double ahead) {
    progress_ = {.done = plan.done, .total = plan.runs};
    ahead_ = ahead;
  }
  const CampaignProgress& finish(const CampaignScene& scene, double wallSeconds) {
    ++progress_.done;
    pass(ofRun(scene), wallSeconds);
    progress_.secondsLeft = ahead_ * wallSeconds_ / passed_;
    return progress_;
  }
  void finishReference(const CampaignScene& scene, double wallSeconds) { pass(ofReference(scene), wallSeconds); }

 private:
  void pass(double charged, double wallSeconds) {
    ahead_ -= charged;
    passed_ += charged;
    wallSeconds_ += wallSeconds;
  }

  const CampaignSettings& settings_;
  CampaignProgress progress_;
  double ahead_ = 0, passed_ = 0, wallSeconds_ = 0;
};

class Campaign {
 public:
  Campaign(const CampaignSettings& settings, const CampaignHooks& hooks)
      : settings_(settings), hooks_(hooks), store_(resultsFile(settings)), pace_(settings) {}

  void putKeys(const std::map<std::string, std::string>& keys) {
    store_.putCampaign(keys);
    store_.addEnvironment(environment(settings_.render));
  }

  bool run() {
    plan();
    for (size_t s = 0; s < settings_.scenes.size(); ++s) {
      if (!runScene(settings_.scenes[s], methodsOfShard(settings_, s))) return false;
    }
    return true;
  }

 private:
  bool isDone(const CampaignScene& scene, Method method, uint64_t seed) {
    return store_.hasRun(scene.name, std::string(toString(method)), seed);
  }
  // Counts what is ahead, and throws now what would be thrown later.
  void plan() {
    CampaignPlan plan;
    double ahead = 0;
    for (size_t s = 0; s < settings_.scenes.size(); ++s) {
      const CampaignScene& entry = settings_.scenes[s];
      const std::vector<Method> methods = methodsOfShard(settings_, s);
      const size_t missing = missingRuns(entry, methods);
      plan.runs += methods.size() * settings_.seeds;
      plan.done += methods.size() * settings_.seeds - missing;
      if (missing == 0) continue;
      ahead += static_cast<double>(missing) * pace_.ofRun(entry);
      if (hasReference(entry)) continue;
      plan.unreferenced.push_back(entry.name);
      plan.referenceSeconds += pace_.ofReference(entry);
    }
    if (!settings_.iterations) plan.renderSeconds = ahead;
    pace_.begin(plan, ahead + plan.referenceSeconds);
    if (settings_.iterations) plan.referenceSeconds = 0;
    if (hooks_.planned) hooks_.planned(plan);
  }

  bool hasReference(const CampaignScene& entry) {
    const Scene scene = load(entry);
    return isKnown(entry, scene) || referenceExists(scene, entry, settings_);
  }

  // Whether the scene was begun by an earlier process, which settled its reference. Throws if it has changed since.
  bool isKnown(const CampaignScene& entry, const Scene& scene) {
    const std::optional<std::string> known = store_.sceneHash(entry.name);
    if (known && *known != hashOf(scene)) {
      throw ResultsFileError(fmt::format("{}: the scene changed since this campaign began; expected scene_hash {}",
                                         entry.file.string(), *known));
    }
    return known.has_value();
  }

  Scene load(const CampaignScene& entry) const {
    LoadOptions loading;
    loading.filmSize = settings_.size;
    return loadScene(entry.file, loading);
  }

  bool stopped() const { return hooks_.stopped && hooks_.stopped(); }

  size_t missingRuns(const CampaignScene& entry, const std::vector<Method>& methods) {
    size_t missing = 0;
    for (const Method method : methods) {
      for (uint64_t seed = 1; seed <= settings_.seeds; ++seed) missing += isDone(entry, method, seed) ? 0 : 1;
    }
    return missing;
  }

  // False if it was stopped.
  bool runScene(const CampaignScene& entry, const std::vector<Method>& methods) {
    if (methods.empty()) return true;
    if (missingRuns(entry, methods) > 0) {
      const auto begin = Clock::now();
      const Scene scene = load(entry);
      const double loadSeconds = secondsSince(begin);
      const Reference reference = this->reference(entry, scene);
      if (stopped()) return false;
      const PreparedReference prepared(referenceFile(entry.name).string(), {reference.mean, Encoding::linear, {}});
      if (!runMissing(entry, scene, methods, prepared, loadSeconds)) return false;
    }
    putBiases(entry, methods);
    return true;
  }

  // Of a scene that an earlier process began the same one; else a new one, with which the scene begins.
  Reference reference(const CampaignScene& entry, const Scene& scene) {
    const fs::path file = referenceFile(entry.name);
    if (isKnown(entry, scene)) return readReference(settings_.out / file);
    const bool exists = referenceExists(scene, entry, settings_);
    const auto begin = Clock::now();
    Reference reference = sceneReference(scene, entry, settings_,
                                         {.watch = hooks_.watch, .stopped = hooks_.stopped, .advance = {}}, hooks_.say);
    if (stopped()) return reference;
    if (!exists) pace_.finishReference(entry, secondsSince(begin));
    store_.putScene({.name = entry.name,
                     .hash = hashOf(scene),
                     .referenceFile = file.string(),
                     .width = settings_.size[0],
                     .height = settings_.size[1],
                     .noiseFloors = reference.noiseFloors,
                     .pathClasses = pathClasses(scene)});
    return reference;
  }

  // What each of the campaign's methods makes of each class of the scene's paths.
  std::vector<PathClassRecord> pathClasses(const Scene& scene) const {
    const PathClassTable table = classifyPaths(scene);
    std::vector<PathClassRecord> records;
    for (const PathClass& entry : table.classes) {
      for (const Method method : settings_.methods) {
        const Verdict verdict = table.verdict(entry, method);
        records.push_back(
            {entry.signature, std::string(toString(method)), std::string(kVerdictNames[static_cast<size_t>(verdict)])});
      }
    }
    return records;
  }

  bool runMissing(const CampaignScene& entry, const Scene& scene, const std::vector<Method>& methods,
                  const PreparedReference& reference, double loadSeconds) {
    for (uint64_t seed = 1; seed <= settings_.seeds; ++seed) {
      for (const Method method : methods) {
        if (isDone(entry, method, seed)) continue;
        const auto begin = Clock::now();
        const std::optional<RunRecord> run = measuredRun({.scene = scene,
                                                          .settings = runSettings(entry, scene, method, seed),
                                                          .schedule = schedule(entry),
                                                          .reference = reference,
                                                          .out = settings_.out,
                                                          .keepImages = settings_.keepImages,
                                                          .loadSeconds = loadSeconds},
                                                         hooks_.watch);
        if (!run || stopped()) return false;
        store_.putRun(*run);
        const CampaignProgress& progress = pace_.finish(entry, secondsSince(begin));
        if (hooks_.finished) hooks_.finished(*run, progress);
      }
    }
    return true;
  }

  RenderSettings runSettings(const CampaignScene& entry, const Scene& scene, Method method, uint64_t seed) const {
    RenderSettings render = settings_.render;
    render.method = method;
    render.seed = seed;
    render.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
    render.measureStages = true;
    render.iterations = settings_.iterations;
    if (!settings_.iterations) render.seconds = entry.effort.seconds;
    return render;
  }

  SnapshotSchedule schedule(const CampaignScene& entry) const {
    if (settings_.iterations) return SnapshotSchedule::doubling();
    const double interval = entry.effort.snapshotSeconds;
    return interval > 0 ? SnapshotSchedule::every(interval) : SnapshotSchedule::logarithmic();
  }

  // Of the methods that have none yet. Every seed of them is done.
  void putBiases(const CampaignScene& entry, const std::vector<Method>& methods) {
    if (settings_.seeds < 2) return;
    const CampaignResults results = readResults(resultsFile(settings_));
    const Reference reference = readReference(settings_.out / referenceFile(entry.name));
    for (const Method method : methods) {
      const std::string name(toString(method));
      const auto known = [&](const BiasRecord& bias) { return bias.scene == entry.name && bias.method == name; };
      if (std::any_of(results.biases.begin(), results.biases.end(), known)) continue;
      std::vector<const RunRecord*> runs;
      for (const RunRecord& run : results.runs) {
        if (run.scene == entry.name && run.method == name && run.state == RunState::done) runs.push_back(&run);
      }
      store_.putBiases(measureBiases(runs, reference));
    }
  }

  const CampaignSettings& settings_;
  const CampaignHooks& hooks_;
  ResultsStore store_;
  Pace pace_;
};

}  // namespace

bool runCampaign(const CampaignSettings& settings, const std::map<std::string, std::string>& keys,
                 const CampaignHooks& hooks) {
  fs::create_directories(settings.out / "images");
  fs::create_directories(settings.out / "references");
  Campaign campaign(settings, hooks);
  campaign.putKeys(keys);
  return campaign.run();
}

}  // namespace wavecrest
