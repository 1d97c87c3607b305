#include "bench/statistics/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wavecrest {
namespace {

// Twice the rank of each value, from 2 on: whole numbers also where equal values share the mean of their ranks.
std::vector<size_t> doubledRanks(std::span<const double> values) {
  std::vector<size_t> order(values.size()), ranks(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  for (size_t first = 0; first < order.size();) {
    size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    // The mean rank of first + 1 to end, doubled.
    for (size_t i = first; i < end; ++i) ranks[order[i]] = first + end + 1;
    first = end;
  }
  return ranks;
}

// The smaller tail at `sum` of a distribution over whole numbers, doubled.
double twoSided(const std::vector<double>& distribution, size_t sum) {
  const auto at = distribution.begin() + static_cast<std::ptrdiff_t>(sum);
  const double low = std::accumulate(distribution.begin(), at + 1, 0.0);
  const double high = std::accumulate(at, distribution.end(), 0.0);
  return std::min(1.0, 2 * std::min(low, high));
}

// Sums of the ranks of n of the values, all choices of n alike.
std::vector<double> sumsOfChoices(const std::vector<size_t>& ranks, size_t n) {
  const size_t most = std::accumulate(ranks.begin(), ranks.end(), size_t{0});
  // ways[k][s]: choices of k values so far with sum s. Doubles hold the counts: C(60, 30) is about 1e17.
  std::vector<std::vector<double>> ways(n + 1, std::vector<double>(most + 1));
  ways[0][0] = 1;
  for (const size_t rank : ranks) {
    // Downwards, so that no choice has the same value twice.
    for (size_t k = n; k-- > 0;) {
      for (size_t s = most - rank + 1; s-- > 0;) ways[k + 1][s + rank] += ways[k][s];
    }
  }
  std::vector<double>& all = ways[n];
  const double count = std::accumulate(all.begin(), all.end(), 0.0);
  for (double& way : all) way /= count;
  return all;
}

double normalTwoSided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

int sideOf(size_t sum, size_t even) { return sum > even ? 1 : sum < even ? -1 : 0; }

}  // namespace

RankTest signedRankTest(std::span<const double> differences) {
  // Sizes and signs, without differences of 0.
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (difference == 0) continue;
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0);
  }
  if (sizes.empty()) return {};
  const std::vector<size_t> ranks = doubledRanks(sizes);
  if (ranks.size() > kMostExactPairs) {
    // Mean and variance of the positive sum; of the ranks as they are, so ties are in it.
    double mean = 0, variance = 0, sum = 0;
    for (size_t i = 0; i < ranks.size(); ++i) {
      const auto rank = static_cast<double>(ranks[i]);
      mean += 0.5 * rank;
      variance += 0.25 * rank * rank;
      if (positive[i]) sum += rank;
    }
    return {normalTwoSided((sum - mean) / std::sqrt(variance)), (sum > mean) - (sum < mean)};
  }
  // Every rank counts for the positive sum with probability one half.
  std::vector<double> distribution(std::accumulate(ranks.begin(), ranks.end(), size_t{0}) + 1);
  distribution[0] = 1;
  size_t reached = 0, positiveSum = 0;
  for (size_t i = 0; i < ranks.size(); ++i) {
    reached += ranks[i];
    // Downwards: smaller sums do not have this rank yet.
    for (size_t s = reached + 1; s-- > 0;) {
      distribution[s] = 0.5 * (distribution[s] + (s >= ranks[i] ? distribution[s - ranks[i]] : 0));
    }
    if (positive[i]) positiveSum += ranks[i];
  }
  return {twoSided(distribution, positiveSum), sideOf(2 * positiveSum, distribution.size() - 1)};
}

RankTest rankSumTest(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) return {};
  std::vector<double> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  const std::vector<size_t> ranks = doubledRanks(all);
  const size_t sum = std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), size_t{0});
  // The doubled ranks of all values sum to N (N + 1), with ties too.
  const int side = sideOf(a.size() * (all.size() + 1), sum);
  if (all.size() <= kMostExact) return {twoSided(sumsOfChoices(ranks, a.size()), sum), side};
  // Mean and variance of a sum drawn without replacement; of the ranks as they are, so ties are in it.
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  double mean = 0, square = 0;
  for (const size_t rank : ranks) {
    mean += static_cast<double>(rank) / (n + m);
    square += static_cast<double>(rank) * static_cast<double>(rank) / (n + m);
  }
  const double variance = n * m / (n + m - 1) * (square - mean * mean);
  return {variance > 0 ? normalTwoSided((static_cast<double>(sum) - n * mean) / std::sqrt(variance)) : 1, side};
}

std::vector<double> holm(std::span<const double> probabilities) {
  std::vector<size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return probabilities[a] < probabilities[b]; });
  std::vector<double> corrected(probabilities.size());
  // From the smallest probability on: times the number of tests that are left, and never below the one before.
  double largest = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(order.size() - i) * probabilities[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

}  // namespace wavecrest
