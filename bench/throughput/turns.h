// Renders several sessions in turn, a slice of time each, and keeps what every slice did.
//
// What is compared is rendered in alternating order (A B, B A, ...), so that other programs and the clock of the CPU
// meet all candidates alike; figures are medians over slices.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/session.h"

namespace wavecrest {

// The median; of an even count the mean of the middle two. values must not be empty.
double median(std::vector<double> values);

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

// slices[session][round]. Every session first renders one slice that is not kept: it fills caches and starts threads.
// afterRound: what else is to be measured in turn with the slices.
std::vector<std::vector<Slice>> renderInTurn(
    std::span<const std::unique_ptr<Session>> sessions, double sliceSeconds, size_t rounds,
    const std::function<void()>& afterRound = [] {});

template <class Projection>
double medianOf(const std::vector<Slice>& slices, Projection&& projection) {
  std::vector<double> values(slices.size());
  std::transform(slices.begin(), slices.end(), values.begin(), projection);
  return median(std::move(values));
}

}  // namespace wavecrest
