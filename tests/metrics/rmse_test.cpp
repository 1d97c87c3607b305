#include "metrics/rmse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

void expectRelative(double actual, double expected) { EXPECT_NEAR(actual / expected, 1.0, 1e-9); }

TEST(Rmse, MatchesGoldenFiguresOfAllPairs) {
  for (const auto& pair : test::goldenPairs()) {
    SCOPED_TRACE(pair.name);
    const auto golden = [&](const char* figure) { return test::goldenFigure("rmse.json", pair.name, figure); };
    expectRelative(rmse(pair.reference, pair.test), golden("rmse_encoded"));
    // The rounding of floats, 6e-8, is of values up to 30 times as large as their differences.
    EXPECT_NEAR(rmse(test::lightOf(pair.reference), test::lightOf(pair.test)) / golden("rmse_linear"), 1, 2e-6);
  }
}

TEST(Rmse, OfFloatImagesIsTheDefinition) {
  const Image a{2, 1, 3, {1, 2, 3, 4, 5, 6}}, b{2, 1, 3, {1, 2, 5, 4, 9, 6}};
  EXPECT_DOUBLE_EQ(rmse(a, b), std::sqrt((4.0 + 16.0) / 6));
  EXPECT_DOUBLE_EQ(rmse(b, a), rmse(a, b)) << "not symmetric";
}

TEST(Rmse, ExcludesNonFinitePixelsOfEitherImage) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Image a{4, 1, 3, {0, 0, 0, nan, 0, 0, 0, 0, inf, 1, 1, 1}};
  const Image b{4, 1, 3, {1, 1, 1, 0, 0, 0, 0, 0, inf, 1, 1, 1}};
  EXPECT_DOUBLE_EQ(rmse(a, b), std::sqrt(3.0 / 6));
  EXPECT_DOUBLE_EQ(relmse(a, b).relmse, 100.0 / 2);  // 1 / epsilon of one of two pixels
}

TEST(Rmse, OfImagesWithoutAFinitePixelIsNotANumber) {
  const Image a{1, 1, 3, {std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  EXPECT_TRUE(std::isnan(rmse(a, a)));
  EXPECT_TRUE(std::isnan(relmse(a, a).relmse));
}

TEST(Relmse, DividesByTheSquaredReferencePlusEpsilon) {
  const Image a{1, 1, 3, {0, 1, 2}}, b{1, 1, 3, {0.5, 1, 1}};
  const double expected = (0.25 / 0.01 + 0 + 1 / 4.01) / 3;
  EXPECT_NEAR(relmse(a, b).relmse, expected, 1e-12);
  EXPECT_NEAR(relmse(a, b, {.epsilon = 1}).relmse, (0.25 + 1.0 / 5) / 3, 1e-12);
}

TEST(Mape, DividesByTheReferencePlusEpsilon) {
  const Image a{1, 1, 3, {0, 1, 2}}, b{1, 1, 3, {0.5, 1, 1}};
  EXPECT_NEAR(mape(a, b), (0.5 / 0.01 + 0 + 1 / 2.01) / 3, 1e-12);
  EXPECT_EQ(mape(a, a), 0);
  const Image c{2, 1, 3, {std::numeric_limits<float>::infinity(), 0, 0, 1, 1, 1}}, d{2, 1, 3, {0, 0, 0, 2, 2, 2}};
  EXPECT_NEAR(mape(c, d), 1 / 1.01, 1e-12) << "pixels that are not finite are excluded";
}

TEST(Relmse, OfBlackReferencesIsTheSquaredErrorOverEpsilon) {
  const Image black{2, 2, 3, std::vector<float>(12, 0.0f)}, grey{2, 2, 3, std::vector<float>(12, 0.1f)};
  EXPECT_EQ(relmse(black, black).relmse, 0.0);
  EXPECT_NEAR(relmse(black, grey).relmse, 1.0, 1e-7);  // 0.1 as a float
}

TEST(Relmse, TrimmedVariantIgnoresOneFireflyInAThousandPixels) {
  Image a{1000, 1, 3, std::vector<float>(3000, 1.0f)}, b = a;
  for (float& v : b.pixels) v += 0.1f;
  const double plain = relmse(a, b).relmse;
  b.pixels[1500] = 1e4f;
  EXPECT_GT(relmse(a, b).relmse, 1e3 * plain);
  EXPECT_NEAR(relmse(a, b).trimmed, plain, 1e-9);
}

}  // namespace
}  // namespace wavecrest
