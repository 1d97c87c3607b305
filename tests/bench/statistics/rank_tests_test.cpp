// Rank tests against probabilities counted by hand, and their false alarms.
#include "bench/statistics/rank_tests.h"

#include <gtest/gtest.h>

#include <random>

namespace wavecrest {
namespace {

TEST(SignedRank, countsSignsAsUneven) {
  // Of 32 choices of signs two are as uneven as all alike.
  EXPECT_DOUBLE_EQ(signedRankTest(std::vector<double>{1, 2, 3, 4, 5}).probability, 2.0 / 32);
  // 14 of 64 subsets of the ranks 1 to 6 have a sum of at most 6, the rank of the one negative value.
  EXPECT_DOUBLE_EQ(signedRankTest(std::vector<double>{1, 2, 3, 4, 5, -6}).probability, 28.0 / 64);
}

// Beyond kMostExactPairs an approximation, in time and memory for a day of pairs.
TEST(SignedRank, ofManyIsApproximatedAsWell) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.08, 1);
  std::vector<double> differences(kMostExactPairs);
  for (double& difference : differences) difference = noise(random);
  const RankTest exact = signedRankTest(differences);
  differences.push_back(1e-9);  // the least rank
  const RankTest approximate = signedRankTest(differences);
  EXPECT_GT(exact.probability, 1e-4);
  EXPECT_LT(exact.probability, 0.3);
  EXPECT_NEAR(approximate.probability / exact.probability, 1, 0.03);
  EXPECT_EQ(approximate.side, exact.side);
  EXPECT_EQ(signedRankTest(std::vector<double>(200000, -1)).side, -1);
}

TEST(SignedRank, sharesRanksAmongEqualValuesAndLeavesOutZeros) {
  EXPECT_DOUBLE_EQ(signedRankTest(std::vector<double>{1, 1, 0, 1, 1}).probability, 2.0 / 16);
  EXPECT_DOUBLE_EQ(signedRankTest(std::vector<double>{0, 0}).probability, 1);
}

TEST(RankSum, countsChoicesAsUneven) {
  EXPECT_DOUBLE_EQ(rankSumTest(std::vector<double>{1, 2, 3}, std::vector<double>{4, 5, 6}).probability, 2.0 / 20);
  EXPECT_DOUBLE_EQ(rankSumTest(std::vector<double>{1, 2, 4}, std::vector<double>{3, 5, 6}).probability, 4.0 / 20);
}

// Fewer values weigh more than many where they are larger.
TEST(SignedRank, sideIsWhereRanksWeighMore) {
  EXPECT_GT(signedRankTest(std::vector<double>{-1, -1, -1, 3, 3}).side, 0);
  EXPECT_LT(signedRankTest(std::vector<double>{1, 1, 1, -3, -3}).side, 0);
  EXPECT_EQ(signedRankTest(std::vector<double>{2, -2, 0}).side, 0);
  EXPECT_EQ(signedRankTest(std::vector<double>{}).side, 0);
}

TEST(RankSum, sideIsWhereRanksWeighMore) {
  const std::vector<double> low{1, 2, 4}, high{4, 5};
  EXPECT_GT(rankSumTest(low, high).side, 0);
  EXPECT_LT(rankSumTest(high, low).side, 0);
  EXPECT_EQ(rankSumTest(low, low).side, 0);
  // Beyond kMostExact as well.
  const std::vector<double> many(kMostExact, 3);
  EXPECT_GT(rankSumTest(low, many).side, 0);
  EXPECT_LT(rankSumTest(high, many).side, 0);
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
      alarms += rankSumTest(a, b).probability <= 0.05 ? 1 : 0;
      found += rankSumTest(a, shifted).probability <= 0.05 ? 1 : 0;
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
