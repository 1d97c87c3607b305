// Where a curve leads that falls as a power of time.
#include "bench/statistics/time_to_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace wavecrest {
namespace {

using LossCurve = std::vector<LossPoint>;

// Snapshots after 1, 2, 4, ... seconds.
LossCurve curve(std::initializer_list<double> losses) {
  LossCurve run;
  for (const double loss : losses) run.push_back({std::ldexp(1.0, static_cast<int>(run.size())), loss});
  return run;
}

TEST(TimeToLoss, followsTheLineOfTheLastPartOfARun) {
  // 1 / t from 2 s on, a quarter of the time; before, anything.
  const std::vector<LossCurve> runs{curve({7, 0.5, 0.25, 0.125})};
  const auto time = timeToLoss(runs, 0.01);
  ASSERT_TRUE(time);
  EXPECT_NEAR(time->seconds, 100, 1e-6);
  // The line has no error, but curves bend: 8 s are the end.
  const double bend = std::pow(100 / 8.0, 0.75);
  EXPECT_NEAR(time->low, 100 / bend, 1e-3);
  EXPECT_NEAR(time->high, 100 * bend, 1e-3);
  EXPECT_NEAR(time->slope.mean, -1, 1e-9);
  EXPECT_NEAR(time->slope.halfWidth, 0, 1e-6);
}

TEST(TimeToLoss, ofOneRunHasTheErrorOfItsLine) {
  // Three points, logarithms of time -1, 0 and 1 times log 2 about the middle. Off the line of slope -1 by d, -2 d and
  // d, whose residual variance is 6 d^2, of one degree of freedom.
  const double d = 0.03;
  const std::vector<LossCurve> runs{curve({1, 0.5 * std::exp(d), 0.25 * std::exp(-2 * d), 0.125 * std::exp(d)})};
  const auto time = timeToLoss(runs, 0.0625);
  ASSERT_TRUE(time);
  EXPECT_NEAR(time->seconds, 16, 1e-6);
  EXPECT_NEAR(time->slope.mean, -1, 1e-9);
  EXPECT_NEAR(time->slope.halfWidth, 12.706 * std::sqrt(6 * d * d / 2) / std::log(2), 1e-3);
  // Two steps beyond the middle: variance 6 d^2 (1 / 3 + 4 / 2).
  const double half = 12.706 * std::sqrt(6 * d * d * (1.0 / 3 + 2));
  EXPECT_NEAR(time->low, 16 * std::exp(-half), 1e-2);
  EXPECT_NEAR(time->high, 16 * std::exp(half), 1e-2);
}

TEST(TimeToLoss, ofSeveralRunsHasTheirSpread) {
  // Slopes -1 and -2: 0.0625 after 16 and after 2 s * 8^(1 / 2).
  const std::vector<LossCurve> runs{curve({1, 0.5, 0.25, 0.125}), curve({2, 0.5, 0.125, 0.03125})};
  const auto time = timeToLoss(runs, 0.0625);
  ASSERT_TRUE(time);
  EXPECT_NEAR(time->seconds, std::sqrt(16 * 2 * std::sqrt(8)), 1e-6);
  EXPECT_NEAR(time->slope.mean, -1.5, 1e-9);
  EXPECT_NEAR(time->slope.halfWidth, 12.706 * 0.5, 1e-3);
}

TEST(TimeToLoss, isUnknownWhereARunDoesNotLeadThere) {
  EXPECT_FALSE(timeToLoss({}, 0.1));
  EXPECT_FALSE(timeToLoss(std::vector<LossCurve>{curve({1, 1, 1, 1})}, 0.1)) << "flat";
  EXPECT_FALSE(timeToLoss(std::vector<LossCurve>{curve({1, 0.5})}, 0.1)) << "two points have no residual";
  EXPECT_FALSE(timeToLoss(std::vector<LossCurve>{curve({1, 0.5, 0.25, NAN})}, 0.1)) << "nor have two that are numbers";
  EXPECT_FALSE(timeToLoss(std::vector<LossCurve>{curve({1, 0.5, 0.25, 0.125}), curve({1, 2, 3, 4})}, 0.1))
      << "one rises";
}

TEST(TimeToLoss, timesAreRoundedToTwoDigits) {
  EXPECT_DOUBLE_EQ(roundedTime(96.4), 96);
  EXPECT_DOUBLE_EQ(roundedTime(1260), 1300);
  EXPECT_DOUBLE_EQ(roundedTime(0.1234), 0.12);
  EXPECT_EQ(roundedTime(0), 0);
  EXPECT_EQ(roundedTime(INFINITY), INFINITY);
}

}  // namespace
}  // namespace wavecrest
