// Speed of a render: paths and rays per second, where the time goes, and how it grows with threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/session.h"

namespace wavecrest {

struct StageShare {
  std::string name;
  double itemsPerPath = 0;
  double nsPerItem = 0, nsPerPath = 0;  // CPU time on one thread
  double share = 0;                     // of all CPU time
  std::optional<double> laneUse;        // items / lanes of the blocks they filled; of stages that work in blocks
};

struct ScalingRow {
  uint32_t threads = 1;
  double pathsPerSecond = 0;  // wall time
  double speedup = 1;         // against one thread
  double cpuEfficiency = 1;   // paths per CPU second against one thread: 1 unless threads hinder each other
};

struct Speed {
  double pathsPerSecond = 0, raysPerSecond = 0;  // wall time, all threads
  double pathsPerCpuSecond = 0;                  // one thread
  double raysPerPath = 0, raysPerCpuSecond = 0;
  size_t bytesPerPath = 0;
  std::vector<StageShare> stages;
  double restShare = 0;             // film and schedule: CPU time of the render outside all stages
  std::vector<ScalingRow> scaling;  // one row per thread count
  RenderStatistics facts;           // instruction set, specialisation, intersector
};

// Renders with 1, 2, 4, ... and settings.threads threads in turn for `seconds` of render time altogether.
Speed measureSpeed(const Scene& scene, const RenderSettings& settings, double seconds);

}  // namespace wavecrest
