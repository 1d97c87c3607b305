// What accuracy costs: speed, difference from double and memory of every precision policy on every instruction set; and
// what specialisation saves: the complete kernels, as far as others were chosen.
//
// All render the same iterations with the same random numbers, so the difference of two images is rounding and what
// follows from it (a path that takes another turn), not Monte Carlo noise.
#pragma once

#include <optional>
#include <vector>

#include "bench/statistics/medians.h"
#include "engine/session/session.h"

namespace wavecrest {

struct PolicyRow {
  Precision precision{};
  Isa isa{};
  Specialization specialization{};
  double pathsPerCpuSecond = 0;                       // median over rounds
  std::optional<Interval> pathsPerCpuSecondInterval;  // of kVisitsForInterval rounds or more; fewer have none
  double meanDifference = 0;                          // (mean - mean of double) / mean of double: a bias
  double pixelDifference = 0;  // root mean square over pixels, relative to that of double's image
  size_t bytesPerPath = 0;
};

struct PolicyTable {
  uint64_t iterations = 0;      // of the images that are compared
  std::vector<PolicyRow> rows;  // double on the best instruction set first: the yardstick
};

PolicyTable measurePolicies(const Scene& scene, const RenderSettings& settings, double seconds);

}  // namespace wavecrest
