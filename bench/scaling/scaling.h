// How a render grows with threads: measured as far as this machine goes, and predicted beyond from its graph of tasks.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/against/child_render.h"
#include "bench/machine/machine_watch.h"
#include "bench/statistics/medians.h"
#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// Rates are paths per second of wall time; speedups are against one thread in the same round.
struct MeasuredScaling {
  uint32_t threads = 1;
  Estimate pathsPerSecond, speedup;
  double processSpeedup = 0;  // of as many processes of one thread each, at the same time
};

struct PredictedScaling {
  uint32_t threads = 1;
  size_t tasks = 0;        // of a slice, cut for so many threads
  double longestTask = 0;  // seconds
  Estimate parallelism;    // work / span: the most that any number of threads could gain
  Estimate speedup;        // of the schedule
};

// An image of parts on so many machines (`render --part`, `merge`).
struct PartsScaling {
  uint32_t machines = 2;
  uint64_t bytes = 0;       // of all parts at one time, a snapshot of the render
  double mergeSeconds = 0;  // to add them up on one machine, once they are in its memory
};

struct ScalingResult {
  std::string scene;
  Method method{};
  uint32_t width = 0, height = 0;
  std::vector<MeasuredScaling> measured;    // 1, 2, 4, ... and settings.threads
  std::vector<PredictedScaling> predicted;  // 2, 4, ... kMostPredictedThreads
  std::vector<PartsScaling> parts;          // 2, 4, ... kMostPredictedMachines
  MachineState machine;                     // meanwhile
};
constexpr uint32_t kMostPredictedThreads = 256, kMostPredictedMachines = 64;

// Measures and records in turn for about `seconds` of render time. Tasks are recorded on one thread while the work is
// cut as for the number of threads in question. file: the scene's, for the processes, which run this program. settings:
// method, instruction set, threads and limits of paths; all else is what `render` takes by default.
ScalingResult measureScaling(const Scene& scene, const std::filesystem::path& file, RenderSettings settings,
                             double seconds);

// What each process renders of the scene: the same image, in so many iterations.
ChildRequest processRequest(const Scene& scene, const std::filesystem::path& file, Method method, uint64_t iterations);

// A table for a terminal.
std::string toText(const ScalingResult& result);
nlohmann::ordered_json toJson(const ScalingResult& result);

}  // namespace wavecrest
