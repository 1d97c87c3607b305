// Verdicts on made-up run times: how often builds of equal speed get one, and how small a loss is found.
#include "bench/against/verdict.h"

#include <gtest/gtest.h>

#include <random>

#include "bench/statistics/rank_tests.h"

namespace wavecrest {
namespace {

// CPU times on a machine that others use: a tenth of the runs meets a neighbour.
class NoisyRuns {
 public:
  explicit NoisyRuns(unsigned seed) : random_(seed) {}
  double run(double seconds) {
    const double outlier = part_(random_) < 0.1 ? 1 + 0.4 * part_(random_) : 1;
    return seconds * outlier * (1 + 0.02 * noise_(random_));
  }
  struct Pairs {
    std::vector<double> ours, other;
  };
  Pairs pairs(size_t count, double slowdown) {
    Pairs pairs;
    for (size_t i = 0; i < count; ++i) {
      pairs.ours.push_back(run(slowdown));
      pairs.other.push_back(run(1));
    }
    return pairs;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> noise_;
  std::uniform_real_distribution<double> part_;
};

SpeedVerdict verdictOn(const NoisyRuns::Pairs& pairs, const FamilyLevel& family) {
  Comparison comparison = comparePaired(pairs.ours, pairs.other, family);
  Comparison* all[] = {&comparison};
  judge(all, family);
  return comparison.verdict;
}

TEST(Verdict, equalBuildsGetNoneInFamiliesOfFortyAsOftenAsStated) {
  constexpr int kFamilies = 100, kComparisons = 40;
  NoisyRuns runs(3);
  int alarms = 0;
  for (int family = 0; family < kFamilies; ++family) {
    std::vector<Comparison> comparisons(kComparisons);
    std::vector<Comparison*> pointers;
    for (Comparison& comparison : comparisons) {
      const NoisyRuns::Pairs pairs = runs.pairs(24, 1);
      std::vector<double> gains;
      for (size_t i = 0; i < pairs.ours.size(); ++i) gains.push_back(std::log(pairs.other[i] / pairs.ours[i]));
      comparison.probability = signedRankTest(gains).probability;  // as comparePaired does, without its interval
      pointers.push_back(&comparison);
    }
    judge(pointers, {.level = 0.05});
    for (const Comparison& comparison : comparisons) {
      if (comparison.verdict == SpeedVerdict::noDifference) continue;
      ++alarms;
      break;
    }
  }
  EXPECT_LE(alarms, 15);  // 5 expected, five standard deviations of 2.2
}

TEST(Verdict, aLossOfThreePercentIsFoundInNineOfTenTries) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    found += verdictOn(NoisyRuns(seed).pairs(60, 1.03), {.level = 0.05}) == SpeedVerdict::slower ? 1 : 0;
  }
  EXPECT_GE(found, 18);
}

TEST(Verdict, ofAFasterBuildIsFaster) {
  EXPECT_EQ(verdictOn(NoisyRuns(1).pairs(60, 0.95), {.level = 0.05}), SpeedVerdict::faster);
}

TEST(Verdict, aLossWithinTheToleranceIsNone) {
  const FamilyLevel family{.level = 0.05, .tolerance = 0.02};
  EXPECT_EQ(verdictOn(NoisyRuns(1).pairs(400, 1.012), {.level = 0.05}), SpeedVerdict::slower);
  EXPECT_EQ(verdictOn(NoisyRuns(1).pairs(400, 1.012), family), SpeedVerdict::noDifference);
  EXPECT_EQ(verdictOn(NoisyRuns(1).pairs(400, 1.05), family), SpeedVerdict::slower);
}

// Of 40 pairs 21 are 0.1 % faster and 19 are 1 % slower: their signed ranks, 231 and 589, have a probability of 0.015.
TEST(Verdict, aMedianAndRanksThatDisagreeGiveNone) {
  NoisyRuns::Pairs pairs{.ours = std::vector<double>(40, 1.0), .other = std::vector<double>(21, 1.001)};
  pairs.other.resize(40, 0.99);
  EXPECT_EQ(verdictOn(pairs, {.level = 0.05}), SpeedVerdict::noDifference);
  // Unpaired: our median is smaller, but of all 400 pairs of one run of ours and one of theirs, ours is larger in 279.
  std::vector<double> ours(11, 1.0), other(11, 1.001);
  ours.resize(20, 2.0);
  other.resize(20, 0.5);
  const Comparison comparison = compareUnpaired(ours, other, {});
  EXPECT_GT(comparison.speedup, 1);
  EXPECT_EQ(comparison.probability, 1);
}

TEST(Verdict, speedupAndItsIntervalAreOfThisBuildOverTheOther) {
  const NoisyRuns::Pairs pairs = NoisyRuns(2).pairs(100, 0.5);
  const Comparison comparison = comparePaired(pairs.ours, pairs.other, {});
  EXPECT_NEAR(comparison.speedup, 2, 0.03);
  EXPECT_LT(comparison.interval.low, comparison.speedup);
  EXPECT_GT(comparison.interval.high, comparison.speedup);
}

}  // namespace
}  // namespace wavecrest
