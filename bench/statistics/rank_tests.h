// Tests of whether two things differ, by ranks: one slow run that another program caused weighs no more than a run that
// is slow by a little. Distributions are exact, with ties, so small samples keep their level.
#pragma once

#include <span>
#include <vector>

namespace wavecrest {

// Wilcoxon's signed-rank test of paired differences: the two-sided probability of ranks as uneven as these if a
// difference were as likely to be d as -d. Differences of 0 are left out; 1 if none is left.
double signedRankProbability(std::span<const double> differences);

// Mann and Whitney's test of two independent samples, two-sided: exact up to kMostExact values together, by the normal
// approximation above. 1 if either is empty.
double rankSumProbability(std::span<const double> a, std::span<const double> b);
constexpr size_t kMostExact = 60;

// Holm's correction: probabilities for many tests at once, so that rejecting those below a level makes any false
// rejection at all no more likely than that level, however the tests depend on each other.
std::vector<double> holm(std::span<const double> probabilities);

}  // namespace wavecrest
