// What a convergence campaign found out, as plain data: the content of one results file, or of several merged.
//
// A campaign is scenes x methods x seeds; each run of it is a row of snapshots, each measured by every metric against
// the scene's reference. Times are seconds of the render clock; paths are relative to the folder of the results file in
// the file itself, and resolved against it once read. Metric values go by scoreName (metrics/metric_list.h): "rmse",
// "relmse", "ssim", "q_mos", "q", "flip", ...; a value that could not be measured is NaN.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

using MetricValues = std::map<std::string, double>;

// Among the values of a snapshot: the mean of (T - A)(T - B) over samples, for an image T and the reference's halves A
// and B. It is the mean square error without the reference's noise, and may come out negative near zero.
constexpr const char* kUnbiasedMse = "unbiased_mse";
// Likewise: seconds that rendering took by both clocks, CPU time being that of all threads together.
constexpr const char *kWallSeconds = "wall_seconds", *kCpuSeconds = "cpu_seconds";

// How one class of light paths fares under one method: "sampled", "inefficient" or "impossible".
struct PathClassRecord {
  std::string pathClass, method, verdict;
};

// One of the scenes, and the reference that its runs were measured against.
struct SceneRecord {
  std::string name;
  std::string hash;           // of everything that the scene was loaded from
  std::string referenceFile;  // EXR; layers as in bench/campaign/reference_file.h
  uint32_t width = 0, height = 0;
  MetricValues noiseFloors = {};  // what the reference's own noise does to each metric
  std::vector<PathClassRecord> pathClasses = {};
};

struct StageRecord {
  std::string name;
  uint64_t items = 0;
  double seconds = 0;  // summed over threads
};

struct SnapshotRecord {
  unsigned number = 0;  // from 0 on
  double renderSeconds = 0;
  uint64_t iterations = 0;
  std::string file;          // EXR
  MetricValues values = {};  // empty until measured
};

// A run is written whole or not at all, so a state is always final.
enum class RunState {
  done,
  refused,  // no image: the method cannot render the scene, or the time was too short; `reason` says which
};
constexpr std::string_view toString(RunState state) { return state == RunState::done ? "done" : "refused"; }

struct RunRecord {
  std::string scene, method;
  uint64_t seed = 0;
  RunState state = RunState::done;
  std::string reason = {};  // of a refusal
  // JSON object: `render --stats` without stages, snapshots and peak_memory_bytes; bench/results/README.md has what is
  // added. Empty where the method cannot render the scene.
  std::string stats = {};
  std::vector<StageRecord> stages = {};
  std::vector<SnapshotRecord> snapshots = {};
};

// Error of the snapshots of one number over all seeds of a method, taken apart. Mean squares over pixels and channels
// of linear radiance, with the reference's own noise removed; bias squared may come out slightly negative.
struct BiasRecord {
  std::string scene, method;
  unsigned number = 0;  // of the snapshot
  unsigned seeds = 0;
  double meanSquareError = 0, variance = 0, biasSquared = 0;
};

// One of the study's findings, judged on this campaign.
struct ClaimRecord {
  std::string id, scene, statement;
  std::string verdict;        // "holds", "does not hold", "not reached in this time", "undecided", "not judged"
  std::string figure = {};    // in some ten words: what decides it, or why it is not judged
  std::string evidence = {};  // values and bands, for people
};

struct CampaignResults {
  std::map<std::string, std::string> campaign;  // settings and environment; keys in bench/results/README.md
  std::vector<SceneRecord> scenes;              // in the order they were added
  std::vector<RunRecord> runs;                  // by scene in that order, then as they were rendered
  std::vector<BiasRecord> biases;
  std::vector<ClaimRecord> claims;

  const SceneRecord* findScene(std::string_view name) const {
    const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const SceneRecord& s) { return s.name == name; });
    return found == scenes.end() ? nullptr : &*found;
  }
  const RunRecord* findRun(std::string_view scene, std::string_view method, uint64_t seed) const {
    const auto found = std::find_if(runs.begin(), runs.end(), [&](const RunRecord& run) {
      return run.scene == scene && run.method == method && run.seed == seed;
    });
    return found == runs.end() ? nullptr : &*found;
  }
};

}  // namespace wavecrest
