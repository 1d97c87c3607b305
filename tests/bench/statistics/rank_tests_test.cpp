// Rank tests against probabilities counted by hand, and their false alarms.
#include "bench/statistics/rank_tests.h"

#include <gtest/gtest.h>

#include <random>

namespace wavecrest {
namespace {

TEST(SignedRank, countsSignsAsUneven) {
  // Of 32 choices of signs two are as uneven as all alike.
  EXPECT_DOUBLE_EQ(signedRankProbability(std::vector<double>{1, 2, 3, 4, 5}), 2.0 / 32);
  // 14 of 64 subsets of the ranks 1 to 6 have a sum of at most 6, the rank of the one negative value.
  EXPECT_DOUBLE_EQ(signedRankProbability(std::vector<double>{1, 2, 3, 4, 5, -6}), 28.0 / 64);
}

TEST(SignedRank, sharesRanksAmongEqualValuesAndLeavesOutZeros) {
  EXPECT_DOUBLE_EQ(signedRankProbability(std::vector<double>{1, 1, 0, 1, 1}), 2.0 / 16);
  EXPECT_DOUBLE_EQ(signedRankProbability(std::vector<double>{0, 0}), 1);
}

TEST(RankSum, countsChoicesAsUneven) {
  EXPECT_DOUBLE_EQ(rankSumProbability(std::vector<double>{1, 2, 3}, std::vector<double>{4, 5, 6}), 2.0 / 20);
  EXPECT_DOUBLE_EQ(rankSumProbability(std::vector<double>{1, 2, 4}, std::vector<double>{3, 5, 6}), 4.0 / 20);
}

// Both sides of kMostExact: the exact distribution and its approximation.
TEST(RankSum, keepsItsLevelAndFindsAShift) {
  constexpr int kExperiments = 400;
  for (const size_t count : {size_t{12}, size_t{40}}) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise;
    int alarms = 0, found = 0;
    for (int i = 0; i < kExperiments; ++i) {
      std::vector<double> a(count), b(count), shifted(count);
      for (size_t k = 0; k < count; ++k) {
        a[k] = noise(random);
        b[k] = noise(random);
        shifted[k] = b[k] + 2;
      }
      alarms += rankSumProbability(a, b) <= 0.05 ? 1 : 0;
      found += rankSumProbability(a, shifted) <= 0.05 ? 1 : 0;
    }
    EXPECT_LE(alarms, 42) << count;  // 20 expected, five standard deviations of 4.4
    EXPECT_GE(alarms, 4) << count;
    EXPECT_GE(found, 0.95 * kExperiments) << count;
  }
}

TEST(Holm, multipliesBySmallerNumbersAndKeepsTheOrder) {
  const std::vector<double> corrected = holm(std::vector<double>{0.01, 0.04, 0.03});
  EXPECT_DOUBLE_EQ(corrected[0], 0.03);
  EXPECT_DOUBLE_EQ(corrected[1], 0.06);
  EXPECT_DOUBLE_EQ(corrected[2], 0.06);
}

}  // namespace
}  // namespace wavecrest
