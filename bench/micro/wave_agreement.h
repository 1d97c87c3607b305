// Whether two runs of a stage gave the same result: the check that stands before every timing.
//
// Instruction sets and intersectors round differently, so a few paths may take another turn at a comparison (an edge, a
// roulette), and compaction then shifts all that follow. Results are therefore matched by the lane they belong to.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/columns/wave.h"

namespace wavecrest {

struct Agreement {
  size_t items = 0, differing = 0;
  double differingFraction() const {
    return items == 0 ? 0 : static_cast<double>(differing) / static_cast<double>(items);
  }
};

namespace detail {

constexpr size_t kAbsent = ~size_t{0};

// A ray without a hit has no coordinates.
inline void clearMisses(Hits& hits) {
  for (size_t i = 0; i < hits.size; ++i) {
    if (hits.primitive[i] == kMiss) hits.u[i] = hits.v[i] = 0;
  }
}

// Where each lane's item is, by the column that names the lane.
inline std::vector<size_t> positions(const uint32_t* lanes, size_t count, size_t laneCount) {
  std::vector<size_t> at(laneCount, kAbsent);
  for (size_t i = 0; i < count; ++i) at.at(lanes[i]) = i;
  return at;
}

// Marks the lanes whose items differ in some column by more than the tolerance, relative to the value or to the
// column's mean magnitude, whichever is greater.
template <class Record>
void markDifferences(Record& expected, Record& actual, const std::vector<size_t>& at, const std::vector<size_t>& other,
                     double tolerance, std::vector<bool>& differs) {
  const auto mark = [&](auto& a, auto& b) {
    if (!a.needed()) return;
    double sum = 0;
    size_t count = 0;
    for (const size_t i : at) {
      if (i == kAbsent || !std::isfinite(static_cast<double>(a[i]))) continue;
      sum += std::abs(static_cast<double>(a[i]));
      ++count;
    }
    const double mean = count == 0 ? 0 : sum / static_cast<double>(count);
    for (size_t lane = 0; lane < at.size(); ++lane) {
      if (at[lane] == kAbsent || other[lane] == kAbsent) continue;
      const double x = static_cast<double>(a[at[lane]]), y = static_cast<double>(b[other[lane]]);
      if (!(std::abs(x - y) <= tolerance * std::max({std::abs(x), std::abs(y), mean}))) differs[lane] = true;
    }
  };
  std::apply([&](auto&... a) { std::apply([&](auto&... b) { (mark(a, b), ...); }, actual.all()); }, expected.all());
}

inline size_t countDifferences(const std::vector<size_t>& at, const std::vector<size_t>& other,
                               std::vector<bool>& differs) {
  size_t count = 0;
  for (size_t lane = 0; lane < at.size(); ++lane) {
    if ((at[lane] == kAbsent) != (other[lane] == kAbsent) || differs[lane]) ++count;
  }
  return count;
}

}  // namespace detail

// Compares paths (with the records that run beside them), shadow rays and radiance of two waves.
template <class S>
Agreement compareWaves(Wave<S>& expected, Wave<S>& actual, double tolerance) {
  const size_t lanes = expected.pathCount;
  std::vector<bool> pathDiffers(lanes), shadowDiffers(lanes), radianceDiffers(lanes);

  const auto paths = detail::positions(expected.paths.lane, expected.paths.size, lanes);
  const auto otherPaths = detail::positions(actual.paths.lane, actual.paths.size, lanes);
  detail::clearMisses(expected.hits);
  detail::clearMisses(actual.hits);
  // Hits and surfaces of another size than the paths are leftovers of an earlier stage.
  const auto compareBeside = [&](auto& a, auto& b) {
    if (a.size == expected.paths.size && b.size == actual.paths.size) {
      detail::markDifferences(a, b, paths, otherPaths, tolerance, pathDiffers);
    }
  };
  compareBeside(expected.paths, actual.paths);
  compareBeside(expected.rays, actual.rays);
  compareBeside(expected.hits, actual.hits);
  compareBeside(expected.surfaces, actual.surfaces);

  const auto shadows = detail::positions(expected.shadowRays.target, expected.shadowRays.size, lanes);
  const auto otherShadows = detail::positions(actual.shadowRays.target, actual.shadowRays.size, lanes);
  detail::markDifferences(expected.shadowRays, actual.shadowRays, shadows, otherShadows, tolerance, shadowDiffers);

  std::vector<size_t> everyLane(lanes);
  for (size_t i = 0; i < lanes; ++i) everyLane[i] = i;
  detail::markDifferences(expected.radiance, actual.radiance, everyLane, everyLane, tolerance, radianceDiffers);

  return {lanes, detail::countDifferences(paths, otherPaths, pathDiffers) +
                     detail::countDifferences(shadows, otherShadows, shadowDiffers) +
                     detail::countDifferences(everyLane, everyLane, radianceDiffers)};
}

}  // namespace wavecrest
