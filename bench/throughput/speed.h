// Speed of a render: paths and rays per second, where the time goes, and how it grows with threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/machine/machine_watch.h"
#include "bench/statistics/medians.h"
#include "bench/throughput/turns.h"
#include "engine/session/session.h"

namespace wavecrest {

struct StageShare {
  std::string name;
  double itemsPerPath = 0;        // over all slices
  Estimate nsPerItem, nsPerPath;  // on one thread
  Estimate share;                 // of all CPU time
  std::optional<double> laneUse;  // items / lanes of the blocks they filled; of stages that work in blocks
};

// slices[visit][slice] of one thread count (SpeedMeasurement).
using VisitSlices = std::vector<std::vector<Slice>>;
// Those of all visits, one after the other.
std::vector<Slice> allSlices(const VisitSlices& visits);

// slices: of one thread that measures its stages, each of whole iterations.
std::vector<StageShare> stageShares(const VisitSlices& slices);

struct ScalingRow {
  uint32_t threads = 1;
  Estimate pathsPerSecond;  // wall time
  Estimate speedup;         // against one thread in the same round
  Estimate cpuEfficiency;   // paths per CPU second against one thread: 1 unless threads hinder each other
  VisitSlices slices;
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

// Measures the speed of a method in visits, between which other measurements are made: a machine that drifts, by its
// clock or its neighbours, does so from one visit to the next, and intervals are of visits.
class SpeedMeasurement {
 public:
  SpeedMeasurement(const Scene& scene, const RenderSettings& settings);

  // Renders with 1, 2, 4, ... and settings.threads threads in turn for about `seconds` of render time altogether. Each
  // visit has sessions of its own and renders the same iterations again, so that visits differ by the machine alone.
  // The first one finds out how many iterations fill a slice, in sessions that it throws away.
  void visit(double seconds);
  // After one visit at least.
  Speed speed() const;

 private:
  std::vector<std::unique_ptr<Session>> makeSessions() const;
  // Sets iterations_.
  void findIterations(double sliceSeconds);

  const Scene& scene_;
  RenderSettings settings_;
  std::vector<uint32_t> threads_;
  std::vector<uint64_t> iterations_;  // of a slice, by thread count
  std::vector<VisitSlices> slices_;   // by thread count
  RenderStatistics facts_;
  MachineWatch watch_;
};

}  // namespace wavecrest
