// Speed of a render: paths and rays per second, where the time goes, and how it grows with threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/machine/machine_watch.h"
#include "bench/statistics/medians.h"
#include "bench/throughput/turns.h"
#include "engine/session.h"

namespace wavecrest {

struct StageShare {
  std::string name;
  double itemsPerPath = 0;        // over all slices
  Estimate nsPerItem, nsPerPath;  // on one thread
  Estimate share;                 // of all CPU time
  std::optional<double> laneUse;  // items / lanes of the blocks they filled; of stages that work in blocks
};

// slices: of one thread that measures its stages, each of whole iterations.
std::vector<StageShare> stageShares(const std::vector<Slice>& slices);

struct ScalingRow {
  uint32_t threads = 1;
  Estimate pathsPerSecond;  // wall time
  Estimate speedup;         // against one thread in the same round
  Estimate cpuEfficiency;   // paths per CPU second against one thread: 1 unless threads hinder each other
  std::vector<Slice> slices;
};

struct Speed {
  Estimate pathsPerSecond, raysPerSecond;        // wall time, all threads
  Estimate pathsPerCpuSecond, raysPerCpuSecond;  // one thread
  double raysPerPath = 0;
  size_t bytesPerPath = 0;
  std::vector<StageShare> stages;
  Estimate restShare;               // film and schedule: CPU time of the render outside all stages
  std::vector<ScalingRow> scaling;  // one row per thread count
  RenderStatistics facts;           // instruction set, specialisation, intersector
  MachineState machine;             // meanwhile
};

// Renders with 1, 2, 4, ... and settings.threads threads in turn for about `seconds` of render time altogether.
Speed measureSpeed(const Scene& scene, const RenderSettings& settings, double seconds);

}  // namespace wavecrest
