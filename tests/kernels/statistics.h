// Statistics for tests of random numbers and of sampling: chi-square and its number of standard deviations.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace wavecrest {

// Tests call a statistic too large above this many standard deviations: one false alarm in 1.7 million per test. Seeds
// are fixed, so a test that passes once passes always; the rate says how surprising a failure after a change is.
constexpr double kMaxDeviations = 5;

// How many standard deviations a chi-square value with k degrees of freedom lies above its mean. Wilson and Hilferty,
// 1931: the cube root is close to normal.
inline double chiSquareDeviations(double chiSquare, double degrees) {
  const double variance = 2 / (9 * degrees);
  return (std::cbrt(chiSquare / degrees) - (1 - variance)) / std::sqrt(variance);
}

// Compares counts with expected counts. Cells expecting fewer than 5 are merged into one (METHODS 10.4).
inline double chiSquareDeviations(std::span<const size_t> counts, std::span<const double> expected) {
  double chiSquare = 0, cells = 0, restCount = 0, restExpected = 0;
  const auto add = [&](double count, double mean) {
    chiSquare += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(static_cast<double>(counts[i]), expected[i]);
    } else {
      restCount += static_cast<double>(counts[i]);
      restExpected += expected[i];
    }
  }
  if (restExpected > 0) add(restCount, restExpected);
  return restExpected == 0 && restCount > 0 ? HUGE_VAL : chiSquareDeviations(chiSquare, cells - 1);
}

// The same for equal cells.
inline double uniformDeviations(std::span<const size_t> counts) {
  size_t total = 0;
  for (const size_t count : counts) total += count;
  const std::vector<double> expected(counts.size(), static_cast<double>(total) / static_cast<double>(counts.size()));
  return chiSquareDeviations(counts, expected);
}

// Deviations from a uniform law of the pairs (a[i], b[i]) on a grid of cells x cells: sees any dependence that shows at
// that resolution, correlation included.
inline double pairDeviations(std::span<const float> a, std::span<const float> b, size_t cells = 32) {
  std::vector<size_t> counts(cells * cells);
  for (size_t i = 0; i < a.size(); ++i) {
    const auto x = static_cast<size_t>(a[i] * static_cast<float>(cells));
    const auto y = static_cast<size_t>(b[i] * static_cast<float>(cells));
    ++counts[y * cells + x];
  }
  return uniformDeviations(counts);
}

// Deviations of the number of runs above and below 1/2 (Wald and Wolfowitz 1940): sees order, which chi-square does
// not.
inline double runsDeviations(std::span<const float> a) {
  double above = 0, runs = 1;
  for (size_t i = 0; i < a.size(); ++i) {
    above += a[i] >= 0.5f ? 1 : 0;
    if (i > 0 && (a[i] >= 0.5f) != (a[i - 1] >= 0.5f)) ++runs;
  }
  const double n = static_cast<double>(a.size()), below = n - above;
  const double mean = 2 * above * below / n + 1;
  return (runs - mean) / std::sqrt((mean - 1) * (mean - 2) / (n - 1));
}

}  // namespace wavecrest
