#include "bench/against/verdict.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>

#include "bench/statistics/rank_tests.h"

namespace wavecrest {
namespace {

std::vector<double> logarithms(std::span<const double> values) {
  std::vector<double> logs(values.size());
  std::transform(values.begin(), values.end(), logs.begin(), [](double value) { return std::log(value); });
  return logs;
}

// Added to the logarithm of a speedup before it is tested. A gain is tested against equal speed, a loss against the
// largest loss that the tolerance allows.
double shift(double medianLog, const FamilyLevel& family) { return medianLog < 0 ? -std::log1p(-family.tolerance) : 0; }

// Within the tolerance there is nothing to reject, however sure the small loss is. The verdict's side is the median's:
// ranks that weigh more on the other side say nothing for it.
double probabilityOf(double medianLog, const FamilyLevel& family, const RankTest& test) {
  const bool tolerated = medianLog < 0 && medianLog + shift(medianLog, family) >= 0;
  return medianLog * test.side > 0 && !tolerated ? test.probability : 1;
}

// From logarithms back to ratios of speed.
Comparison fromLogs(double medianLog, const Interval& interval, double probability) {
  return {.speedup = std::exp(medianLog),
          .interval = {std::exp(interval.low), std::exp(interval.high)},
          .probability = probability};
}

}  // namespace

std::string_view toString(SpeedVerdict verdict) {
  constexpr std::string_view kWords[] = {"no difference", "faster", "slower"};
  return kWords[static_cast<size_t>(verdict)];
}

Comparison comparePaired(std::span<const double> ours, std::span<const double> other, const FamilyLevel& family) {
  assert(ours.size() == other.size() && !ours.empty());
  // Logarithm of the speedup in each pair: the other build's time over ours.
  std::vector<double> gains = logarithms(other);
  const std::vector<double> own = logarithms(ours);
  for (size_t i = 0; i < gains.size(); ++i) gains[i] -= own[i];
  const double middle = median(gains);
  const Interval interval = bootstrapMedian(gains);
  for (double& gain : gains) gain += shift(middle, family);
  return fromLogs(middle, interval, probabilityOf(middle, family, signedRankTest(gains)));
}

Comparison compareUnpaired(std::span<const double> ours, std::span<const double> other, const FamilyLevel& family) {
  assert(!ours.empty() && !other.empty());
  std::vector<double> own = logarithms(ours);
  const std::vector<double> theirs = logarithms(other);
  // Logarithm of the speedup: the other build's median time over ours.
  const double middle = median(theirs) - median(own);
  // Bootstrap of the difference of two medians: both samples are drawn anew each time.
  std::mt19937_64 random(own.size() + theirs.size());
  std::vector<double> differences(kResamples);
  const auto drawMedian = [&](const std::vector<double>& values) {
    std::vector<double> sample(values.size());
    for (double& value : sample) value = values[random() % values.size()];
    return median(std::move(sample));
  };
  for (double& difference : differences) difference = drawMedian(theirs) - drawMedian(own);
  std::sort(differences.begin(), differences.end());
  const auto at = [&](double part) { return differences[static_cast<size_t>(part * (kResamples - 1))]; };
  const Interval interval{at(0.5 * (1 - kIntervalLevel)), at(0.5 * (1 + kIntervalLevel))};
  // A shift of the logarithmic speedup is a shift of our times in the opposite direction.
  for (double& value : own) value -= shift(middle, family);
  return fromLogs(middle, interval, probabilityOf(middle, family, rankSumTest(own, theirs)));
}

void judge(std::span<Comparison* const> comparisons, const FamilyLevel& family) {
  std::vector<double> probabilities;
  for (const Comparison* comparison : comparisons) probabilities.push_back(comparison->probability);
  probabilities = holm(probabilities);
  for (size_t i = 0; i < comparisons.size(); ++i) {
    Comparison& comparison = *comparisons[i];
    comparison.probability = probabilities[i];
    // Above the level the verdict stays noDifference.
    if (comparison.probability > family.level) continue;
    comparison.verdict = comparison.speedup > 1 ? SpeedVerdict::faster : SpeedVerdict::slower;
  }
}

}  // namespace wavecrest
