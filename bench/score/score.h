// `wavecrest bench --score`: one figure for a machine, from a fixed workload whose images prove that it was rendered.
//
// Each entry of the workload (workload.h) is rendered on all threads in slices. The image after the first slice must
// have the committed hash (expected.h). Only a build that did not make the hash may round otherwise: its image must
// look like the committed picture (picture.h). A build that renders something else gets no score. The relMSE against
// the scene's committed reference after slices 1, 2, 4 and 8 says what the speed buys. One thread then renders the
// slices again, which gives the speed of a core and the cost of each stage. Last, as many processes as threads render
// one slice each at the same time.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/machine/machine_watch.h"
#include "bench/machine/perf_events.h"
#include "bench/score/image_verdict.h"
#include "bench/score/roofline.h"
#include "bench/statistics/medians.h"
#include "bench/throughput/speed.h"

namespace wavecrest {

struct QualityAtTime {
  double seconds = 0, cpuSeconds = 0;  // of the render on all threads
  double samplesPerPixel = 0;
  double relmse = 0;
};

struct ScoredStage {
  StageShare share;                                  // on one thread
  std::optional<size_t> bytesPerItem;                // of columns (roofline.h)
  std::array<double, kStageEvents> eventsPerItem{};  // kHardwareEvents, where they are counted
};

struct ScoreRow {
  ScoreEntry entry;
  ImageVerdict image;
  Estimate pathsPerSecond;             // wall time, all threads, over slices
  Estimate pathsPerCpuSecond;          // one thread
  double processesPathsPerSecond = 0;  // of as many processes as threads, together
  double score = 0, coreScore = 0;
  std::vector<QualityAtTime> quality;
  std::vector<ScoredStage> stages;
  RenderStatistics facts;  // of the one thread
};

struct ScoreResult {
  ScoreSize size{};
  Isa isa{};
  uint32_t threads = 1;
  Ceilings ceilings;
  std::string eventsRefusal;  // why cycles, instructions and cache misses are not counted; empty if they are
  std::vector<ScoreRow> rows;
  MachineState machine;

  bool allAccepted() const;
  // Geometric mean over entries: 100 is a core of the reference machine. method: of its entries alone.
  double score(std::optional<Method> method = {}) const;
  double coreScore(std::optional<Method> method = {}) const;
  std::vector<std::string> doubts() const;
};

struct ScoreRequest {
  ScoreSize size{};
  std::vector<ScoreEntry> entries;  // of workloadOf(size), or some of them
  Isa isa{};
  uint32_t threads = 1;
  // Of a scene by its name: file, and folder of references.
  std::function<std::filesystem::path(const std::string&)> sceneFile;
  std::filesystem::path references;
};

// progress: called after each entry with its row.
ScoreResult measureScore(const ScoreRequest& request, const ExpectedImages& expected,
                         const std::function<void(const ScoreRow&)>& progress);

// Renders the slices of the row's entry on one thread: its speed, the stages and the facts of the row. Events are
// counted in a slice that is not timed; zeros where they cannot be. No StageEventCounter may live.
void measureOneThread(const Scene& scene, RenderSettings settings, const std::array<PerfEvent, kStageEvents>& events,
                      ScoreRow& row);

// An entry's image after its first slice, rendered with any number of threads.
Image validatedImage(const Scene& scene, const ScoreEntry& entry, Isa isa, uint32_t threads);

// Printed as it goes: a heading, a line for each entry, and the rest.
std::string scoreHeading(const ScoreRequest& request);
std::string toText(const ScoreRow& row);
std::string toText(const ScoreResult& result);
nlohmann::ordered_json toJson(const ScoreResult& result);

}  // namespace wavecrest
