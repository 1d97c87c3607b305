// Tests of whether two things differ, by ranks: one slow run that another program caused weighs no more than a run that
// is slow by a little. Distributions of small samples are exact, with ties, so they keep their level.
#pragma once

#include <span>
#include <vector>

namespace wavecrest {

struct RankTest {
  double probability = 1;  // two-sided: of ranks as uneven as these without a difference
  int side = 0;            // above 0 where positive differences, or the values of b, weigh more; 0 where none does
};

// Wilcoxon's signed-rank test of paired differences: without a difference d is as likely as -d. Differences of 0 are
// left out; probability 1 if none is left. Exact up to kMostExactPairs of them, by the normal approximation above.
RankTest signedRankTest(std::span<const double> differences);
constexpr size_t kMostExactPairs = 1000;

// Mann and Whitney's test of two independent samples: exact up to kMostExact values together, by the normal
// approximation above. Probability 1 if either is empty.
RankTest rankSumTest(std::span<const double> a, std::span<const double> b);
constexpr size_t kMostExact = 60;

// Holm's correction: probabilities for many tests at once, so that rejecting those below a level makes any false
// rejection at all no more likely than that level, however the tests depend on each other.
std::vector<double> holm(std::span<const double> probabilities);

}  // namespace wavecrest
