// Renders several sessions in turn, a slice each, and keeps what every slice did.
//
// A slice is a number of whole iterations, so it covers all of the image: parts of an image cost differently. What is
// compared is rendered in alternating order (A B, B A, ...), so that other programs and the clock of the CPU meet all
// candidates alike; figures are medians over slices, with intervals.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bench/statistics/medians.h"
#include "engine/session/session.h"

namespace wavecrest {

// What one session did in one slice.
struct Slice {
  double seconds = 0, cpuSeconds = 0;
  uint64_t paths = 0;
  StageCounters counters;
  std::vector<RenderStatistics::StageRow> stages;

  double pathsPerSecond() const { return static_cast<double>(paths) / seconds; }
  double pathsPerCpuSecond() const { return static_cast<double>(paths) / cpuSeconds; }
  double rays() const { return static_cast<double>(counters.raysClosest + counters.raysShadow); }
};

// A session that goes on by the same number of iterations each time.
class SliceRenderer {
 public:
  explicit SliceRenderer(Session& session, uint64_t iterations = 1)
      : session_(session), iterations_(iterations), done_(session.statistics().iterations) {}

  // Doubles the iterations until a slice takes half of the time or more. The first render does not count: chains
  // bootstrap in it. Chains advance in steps of many mutations; a slice must hold several, so that none is left empty.
  void fill(double sliceSeconds);
  Slice render();
  uint64_t iterations() const { return iterations_; }

 private:
  Session& session_;
  uint64_t iterations_, done_;
};

struct TurnPlan {
  double seconds = 0;                       // render time of all sessions together, about
  size_t fewestRounds = 1, mostRounds = 1;  // where an iteration takes long, fewest rounds may take more time
};

// Renders a slice of each in turn, round by round: first to last, then last to first, until rounds are many enough and
// the time is spent. slices[renderer][round]. afterRound: what else is to be done in turn with the slices.
std::vector<std::vector<Slice>> renderInTurn(
    std::span<SliceRenderer> renderers, const TurnPlan& plan, const std::function<void()>& afterRound = [] {});

// slices[session][round]. Slices of one session have the same number of iterations, a power of two, as many as fill its
// share of the time. How long they take is found in renders that are not kept; those also fill caches and start
// threads.
std::vector<std::vector<Slice>> renderInTurn(
    std::span<const std::unique_ptr<Session>> sessions, const TurnPlan& plan,
    const std::function<void()>& afterRound = [] {});

template <class Projection>
std::vector<double> valuesOf(const std::vector<Slice>& slices, Projection&& projection) {
  std::vector<double> values(slices.size());
  std::transform(slices.begin(), slices.end(), values.begin(), projection);
  return values;
}

}  // namespace wavecrest
