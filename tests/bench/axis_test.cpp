#include "bench/report/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wavecrest {
namespace {

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> found;
  for (const AxisTick& tick : axis.ticks()) {
    if (!tick.label.empty()) found.push_back(tick.label);
  }
  return found;
}

TEST(Axis, logarithmicPositionIsLinearInTheExponent) {
  const Axis axis(AxisScale::kLogarithmic, 0.01, 100);
  EXPECT_NEAR(axis.position(1), 0.5, 1e-12);
  EXPECT_NEAR(axis.position(10) - axis.position(1), axis.position(1) - axis.position(0.1), 1e-12);
  EXPECT_GT(axis.position(0.01), 0);
  EXPECT_LT(axis.position(100), 1);
}

TEST(Axis, labelsPowersOfTenOverSeveralDecades) {
  EXPECT_EQ(labels(Axis(AxisScale::kLogarithmic, 0.01, 100)),
            (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
}

TEST(Axis, labelsTwoAndFiveOnAShortLogarithmicAxis) {
  EXPECT_EQ(labels(Axis(AxisScale::kLogarithmic, 0.9, 21)), (std::vector<std::string>{"1", "2", "5", "10", "20"}));
}

TEST(Axis, thinsLabelsAndMinorLinesOverManyDecades) {
  const Axis axis(AxisScale::kLogarithmic, 1e-12, 1e9);
  EXPECT_LE(labels(axis).size(), 9U);
  EXPECT_EQ(axis.ticks().size(), labels(axis).size());
}

// Whatever the data, a reader needs two labels to read off a scale.
TEST(Axis, alwaysHasAtLeastTwoLabels) {
  for (const double low : {1e-30, 3.3e-5, 0.6, 1.0, 2.1, 5.1, 9.99, 4e7}) {
    for (const double ratio : {1.0, 1.0001, 1.7, 30.0, 1e8}) {
      EXPECT_GE(labels(Axis(AxisScale::kLogarithmic, low, low * ratio)).size(), 2U) << low << " x " << ratio;
      EXPECT_GE(labels(Axis(AxisScale::kLinear, low, low * ratio)).size(), 2U) << low << " x " << ratio;
    }
  }
  EXPECT_GE(labels(Axis(AxisScale::kLinear, -3, 0)).size(), 2U);
  EXPECT_GE(labels(Axis(AxisScale::kLinear, 0, 0)).size(), 2U);
}

TEST(Axis, linearTicksAreRoundNumbersInsideTheAxis) {
  const Axis axis(AxisScale::kLinear, 0.62, 0.99);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"0.7", "0.8", "0.9", "1"}));
  for (const AxisTick& tick : axis.ticks()) {
    EXPECT_GE(axis.position(tick.value), 0);
    EXPECT_LE(axis.position(tick.value), 1);
  }
}

TEST(TickLabel, writesFarValuesAsPowers) {
  EXPECT_EQ(tickLabel(0), "0");
  EXPECT_EQ(tickLabel(0.002), "0.002");
  EXPECT_EQ(tickLabel(50000), "50000");
  EXPECT_EQ(tickLabel(1e-6), "10⁻⁶");
  EXPECT_EQ(tickLabel(2e7), "2·10⁷");
  EXPECT_EQ(tickLabel(1e12), "10¹²");
  EXPECT_EQ(tickLabel(1e-20), "10⁻²⁰");
}

}  // namespace
}  // namespace wavecrest
