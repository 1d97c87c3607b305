// Lines through points by least squares.
#include "bench/statistics/line_fit.h"

#include <gtest/gtest.h>

#include <array>

namespace wavecrest {
namespace {

TEST(LineFit, goesThroughTwoPoints) {
  const auto line = lineThrough(std::array<LinePoint, 2>{{{1, 5}, {3, 1}}});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->slope, -2);
  EXPECT_EQ(line->meanX, 2);
  EXPECT_EQ(line->meanY, 3);
  EXPECT_EQ(line->residual, 0);
}

// Off the line y = x by 1, -2 and 1: the residual variance is 6 of one degree of freedom.
TEST(LineFit, hasTheVarianceOfThePointsAboutIt) {
  const auto line = lineThrough(std::array<LinePoint, 3>{{{-1, 0}, {0, -2}, {1, 2}}});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->slope, 1);
  EXPECT_EQ(line->meanY, 0);
  EXPECT_EQ(line->squaresX, 2);
  EXPECT_DOUBLE_EQ(line->residual, 6);
}

TEST(LineFit, takesTwoDifferentPlaces) {
  EXPECT_FALSE(lineThrough({}));
  EXPECT_FALSE(lineThrough(std::array<LinePoint, 1>{{{1, 2}}}));
  EXPECT_FALSE(lineThrough(std::array<LinePoint, 3>{{{0.1, 2}, {0.1, 3}, {0.1, 4}}})) << "whatever sums of 0.1 are";
}

}  // namespace
}  // namespace wavecrest
