#include "bench/statistics/medians.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>

namespace wavecrest {
namespace {

constexpr size_t kFewestForBootstrap = 6;

// By linear interpolation between sorted values; part in 0..1.
double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

double median(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

Interval bootstrapMedian(std::span<const double> values) {
  assert(!values.empty());
  if (values.size() < kFewestForBootstrap) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
  }
  // A fixed seed. The remainder of 64 bits by a small count is as good as uniform.
  std::mt19937_64 random(values.size());
  std::vector<double> medians(kResamples), sample(values.size());
  for (double& middle : medians) {
    for (double& value : sample) value = values[random() % values.size()];
    middle = median(sample);
  }
  std::sort(medians.begin(), medians.end());
  return {quantile(medians, 0.5 * (1 - kIntervalLevel)), quantile(medians, 0.5 * (1 + kIntervalLevel))};
}

Estimate estimateMedian(std::span<const double> values) {
  return {.value = median({values.begin(), values.end()}), .interval = bootstrapMedian(values)};
}

Estimate estimateMedianOfVisits(std::span<const std::vector<double>> visits) {
  assert(!visits.empty());
  if (visits.size() == 1) return estimateMedian(visits.front());
  // The medians of the visits, in ascending order.
  std::vector<double> medians;
  for (const std::vector<double>& values : visits) medians.push_back(median(values));
  std::sort(medians.begin(), medians.end());
  // k values of n are below the median with probability C(n, k) / 2^n. As many are left out at either end as the
  // level allows.
  const size_t n = medians.size();
  size_t outside = 0;
  // term: C(n, k) / 2^n for k = outside; tail: the sum of terms up to k.
  double term = std::ldexp(1.0, -static_cast<int>(n)), tail = term;
  while (2 * (outside + 1) < n) {
    term *= static_cast<double>(n - outside) / static_cast<double>(outside + 1);
    tail += term;
    if (2 * tail > 1 - kIntervalLevel) break;
    ++outside;
  }
  return {.value = quantile(medians, 0.5), .interval = {medians[outside], medians[n - 1 - outside]}};
}

double relativeSpread(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  const double middle = quantile(values, 0.5);
  return middle > 0 ? (quantile(values, 0.75) - quantile(values, 0.25)) / middle : 0;
}

}  // namespace wavecrest
