// From measurements of two builds to a verdict: faster, slower, or no difference beyond noise.
//
// Each pair of runs gives the logarithm of the speed of one build over the other's. The interval of their median is a
// bootstrap; the verdict comes from Wilcoxon's signed-rank test, corrected for the number of comparisons (Holm), so
// that any verdict at all between builds of equal speed is no more likely than the family's level.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "bench/statistics/medians.h"

namespace wavecrest {

enum class SpeedVerdict { noDifference, faster, slower };
std::string_view toString(SpeedVerdict verdict);

struct Comparison {
  double speedup = 1;       // this build's speed over the other's, median
  Interval interval{1, 1};  // of the median, kIntervalLevel for this comparison alone
  // Of ranks this uneven without a difference, 1 where they weigh more on the other side than the median's; after
  // judge(), corrected for the family.
  double probability = 1;
  SpeedVerdict verdict{};
};

struct FamilyLevel {
  double level = 0.05;   // probability of any false verdict
  double tolerance = 0;  // a build that is slower by no more than this part is not called slower
};

// Paired: ours[i] and other[i] were measured one right after the other. Times of equal work.
Comparison comparePaired(std::span<const double> ours, std::span<const double> other, const FamilyLevel& family);
// Independent measurements, in any number.
Comparison compareUnpaired(std::span<const double> ours, std::span<const double> other, const FamilyLevel& family);

// Corrects the probabilities of all comparisons of one question, and decides.
void judge(std::span<Comparison* const> comparisons, const FamilyLevel& family);

}  // namespace wavecrest
