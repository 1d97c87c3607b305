#include "bench/throughput/doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wavecrest {
namespace {

// How much longer the wider of these figures would have to be measured to be known to kWideInterval, on a machine that
// does not drift: its error falls with the root.
void doubtPrecision(const Speed& speed, std::vector<std::string>& doubts) {
  const double error = std::max(speed.pathsPerSecond.relativeError(), speed.pathsPerCpuSecond.relativeError());
  if (error <= kWideInterval) return;
  const double times = error / kWideInterval;
  const VisitSlices& visits = speed.scaling.front().slices;
  doubts.push_back(
      fmt::format("paths/s are known to {:.0f} % only, from {} slices in {} visits: expected within {:.0f} %; try "
                  "{:.0f} times the duration, or a quieter machine",
                  100 * error, allSlices(visits).size(), visits.size(), 100 * kWideInterval, std::ceil(times * times)));
}

void doubtSlices(const ScalingRow& row, std::vector<std::string>& doubts) {
  const double spread =
      relativeSpread(valuesOf(allSlices(row.slices), [](const Slice& s) { return s.pathsPerCpuSecond(); }));
  if (spread <= kWideSpread) return;
  doubts.push_back(fmt::format("slices on {} thread{} differ by {:.0f} % in CPU time: the machine is not quiet",
                               row.threads, row.threads == 1 ? "" : "s", 100 * spread));
}

void doubtEfficiency(const ScalingRow& row, std::vector<std::string>& doubts) {
  const double efficiency = std::max(row.speedup.value / row.threads, row.cpuEfficiency.value);
  if (efficiency <= kImpossibleEfficiency) return;
  doubts.push_back(fmt::format("{} threads come out at {:.0f} % efficiency, which cannot be: one thread was held up",
                               row.threads, 100 * efficiency));
}

}  // namespace

std::vector<std::string> doubtsAbout(const Speed& speed) {
  std::vector<std::string> doubts = doubtsAbout(speed.machine);
  doubtPrecision(speed, doubts);
  for (const ScalingRow& row : speed.scaling) {
    doubtSlices(row, doubts);
    doubtEfficiency(row, doubts);
  }
  return doubts;
}

}  // namespace wavecrest
