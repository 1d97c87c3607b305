// Medians and their intervals.
#include "bench/statistics/medians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wavecrest {
namespace {

TEST(Median, ofAnEvenCountIsTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 10}), 3);
}

TEST(BootstrapMedian, holdsTheTrueMedianAboutAsOftenAsStated) {
  constexpr int kExperiments = 300;
  std::mt19937 random(1);
  std::lognormal_distribution<double> noise(0, 0.3);  // median 1, not symmetric
  int held = 0;
  for (int i = 0; i < kExperiments; ++i) {
    std::vector<double> values(21);
    for (double& value : values) value = noise(random);
    const Interval interval = bootstrapMedian(values);
    held += interval.low <= 1 && 1 <= interval.high ? 1 : 0;
  }
  // 95 %, of which a percentile bootstrap of 21 values may miss a little; a standard error here is 1.3 %.
  EXPECT_GE(held, 0.88 * kExperiments);
  EXPECT_LE(held, 0.99 * kExperiments);
}

TEST(BootstrapMedian, ofFewValuesIsTheirRange) {
  const Interval interval = bootstrapMedian(std::vector<double>{5, 1, 3});
  EXPECT_EQ(interval.low, 1);
  EXPECT_EQ(interval.high, 5);
}

TEST(BootstrapMedian, isRepeatable) {
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(bootstrapMedian(values).low, bootstrapMedian(values).low);
}

TEST(MedianOfVisits, ofOneVisitIsThatOfItsValues) {
  const std::vector<std::vector<double>> visits{{1, 2, 3, 4, 5, 6, 7}};
  EXPECT_EQ(estimateMedianOfVisits(visits).value, 4);
  EXPECT_EQ(estimateMedianOfVisits(visits).interval.low, estimateMedian(visits[0]).interval.low);
}

TEST(MedianOfVisits, leavesOutAsManyVisitsAsTheLevelAllows) {
  std::vector<std::vector<double>> visits;
  const auto interval = [&](size_t count) {
    visits.clear();
    for (size_t i = 1; i <= count; ++i) visits.push_back({static_cast<double>(i)});
    return estimateMedianOfVisits(visits).interval;
  };
  // Tables of the sign test: 6 values hold the median with 96.9 %, 8 without the extremes with 93.0 %, 9 with 96.1 %,
  // 20 without five at either end with 95.9 %.
  EXPECT_EQ(interval(6).low, 1);
  EXPECT_EQ(interval(6).high, 6);
  EXPECT_EQ(interval(8).low, 1);
  EXPECT_EQ(interval(9).low, 2);
  EXPECT_EQ(interval(9).high, 8);
  EXPECT_EQ(interval(20).low, 6);
  EXPECT_EQ(interval(20).high, 15);
}

// Two measurements of one thing on a machine that drifts: intervals of single slices would miss each other.
TEST(MedianOfVisits, holdsTheTrueMedianOfAMachineThatDrifts) {
  constexpr int kExperiments = 300;
  std::mt19937 random(3);
  std::normal_distribution<double> drift(1, 0.05), noise(0, 0.005);
  int held = 0, heldByValues = 0;
  for (int i = 0; i < kExperiments; ++i) {
    std::vector<std::vector<double>> visits(kVisitsForInterval);
    std::vector<double> all;
    for (std::vector<double>& visit : visits) {
      const double speed = drift(random);
      for (int k = 0; k < 15; ++k) visit.push_back(speed + noise(random));
      all.insert(all.end(), visit.begin(), visit.end());
    }
    const auto holds = [](const Interval& interval) { return interval.low <= 1 && 1 <= interval.high ? 1 : 0; };
    held += holds(estimateMedianOfVisits(visits).interval);
    heldByValues += holds(estimateMedian(all).interval);
  }
  EXPECT_GE(held, 0.94 * kExperiments);
  EXPECT_LE(heldByValues, 0.8 * kExperiments);
}

TEST(RelativeSpread, isTheDistanceOfTheQuartilesOverTheMedian) {
  EXPECT_DOUBLE_EQ(relativeSpread({1, 2, 3, 4, 5}), (4.0 - 2.0) / 3.0);
}

}  // namespace
}  // namespace wavecrest
