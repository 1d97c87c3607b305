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
  EXPECT_LT(bootstrapMedian(values, 0.5).halfWidth(), bootstrapMedian(values, 0.99).halfWidth());
}

TEST(RelativeSpread, isTheDistanceOfTheQuartilesOverTheMedian) {
  EXPECT_DOUBLE_EQ(relativeSpread({1, 2, 3, 4, 5}), (4.0 - 2.0) / 3.0);
}

}  // namespace
}  // namespace wavecrest
