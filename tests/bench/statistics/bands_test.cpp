// Bands of means and differences, against textbook values.
#include "bench/statistics/bands.h"

#include <gtest/gtest.h>

#include <tuple>

#include <array>
#include <cmath>

namespace wavecrest {
namespace {

TEST(Bands, quantilesAreThoseOfStudent) {
  EXPECT_DOUBLE_EQ(studentQuantile(1), 12.706);
  EXPECT_DOUBLE_EQ(studentQuantile(0.3), 12.706);
  EXPECT_DOUBLE_EQ(studentQuantile(4.9), 2.776);
  EXPECT_DOUBLE_EQ(studentQuantile(20), 2.086);
  EXPECT_NEAR(studentQuantile(30), 2.042, 0.005 * 2.042);
  EXPECT_NEAR(studentQuantile(60), 2.000, 0.005 * 2.000);
  EXPECT_NEAR(studentQuantile(1e6), 1.960, 0.001);
}

TEST(Bands, aMeanHasTheBandOfItsStandardError) {
  const Band band = meanBand(std::array{1.0, 2.0, 3.0});  // standard deviation 1, standard error 1 / sqrt(3)
  EXPECT_DOUBLE_EQ(band.mean, 2);
  EXPECT_NEAR(band.halfWidth, 4.303 / std::sqrt(3.0), 1e-12);
}

TEST(Bands, aDifferenceHasWelchsBand) {
  // Variances of the means 1/3 and 4/3: degrees of freedom (5/3)^2 / ((1/3)^2 / 2 + (4/3)^2 / 2) = 2.94.
  const Band band = differenceBand(std::array{1.0, 2.0, 3.0}, std::array{8.0, 10.0, 12.0});
  EXPECT_DOUBLE_EQ(band.mean, -8);
  EXPECT_NEAR(band.halfWidth, 4.303 * std::sqrt(5.0 / 3.0), 1e-12);
}

TEST(Bands, oneValueHasNone) {
  EXPECT_TRUE(std::isinf(meanBand(std::array{1.0}).halfWidth));
  EXPECT_TRUE(std::isinf(differenceBand(std::array{1.0}, std::array{1.0, 1.1}).halfWidth));
}

TEST(Bands, equalValuesHaveAnEmptyBand) {
  EXPECT_EQ(differenceBand(std::array{2.0, 2.0}, std::array{1.0, 1.0}).halfWidth, 0);
}

// Tables of Student's distribution: the two-sided 5 %, 1 % and 0.1 % points.
TEST(StudentTail, isThatOfTheTables) {
  for (const auto& [t, degrees, tail] : {std::tuple{12.706, 1, 0.05},
                                         {4.303, 2, 0.05},
                                         {9.925, 2, 0.01},
                                         {3.182, 3, 0.05},
                                         {2.571, 5, 0.05},
                                         {4.032, 5, 0.01},
                                         {6.869, 5, 0.001},
                                         {2.228, 10, 0.05},
                                         {4.587, 10, 0.001},
                                         {1.980, 120, 0.05}}) {
    EXPECT_NEAR(studentTail(t, degrees), tail, 2e-3 * tail) << t << ", " << degrees;
    EXPECT_EQ(studentTail(-t, degrees), studentTail(t, degrees));
  }
  EXPECT_EQ(studentTail(0, 7), 1);
}

}  // namespace
}  // namespace wavecrest
