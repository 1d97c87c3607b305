#include "metrics/rmse.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

void expectRelative(double actual, double expected) { EXPECT_NEAR(actual / expected, 1.0, 1e-9); }

TEST(Rmse, MatchesGoldenFiguresOfAllPairs) {
  for (const auto& pair : test::goldenPairs()) {
    SCOPED_TRACE(pair.name);
    const auto golden = [&](const char* figure, auto... index) {
      return test::goldenFigure("rmse.json", pair.name, figure, index...);
    };
    const RmseResult linear = rmse(pair.reference, pair.test, CodeScale::linear);
    expectRelative(linear.rmse, golden("rmse_linear"));
    for (size_t c = 0; c < 3; ++c) expectRelative(linear.channels[c], golden("rmse_linear_rgb", c));
    expectRelative(rmse(pair.reference, pair.test, CodeScale::gammaCorrected).rmse, golden("rmse_encoded"));
  }
}

TEST(Rmse, OfFloatImagesIsTheDefinition) {
  const Image a{2, 1, 3, {1, 2, 3, 4, 5, 6}}, b{2, 1, 3, {1, 2, 5, 4, 9, 6}};
  const RmseResult result = rmse(a, b);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt((4.0 + 16.0) / 6));
  EXPECT_DOUBLE_EQ(result.channels[1], std::sqrt(16.0 / 2));
  EXPECT_DOUBLE_EQ(rmse(b, a).rmse, result.rmse) << "not symmetric";
}

TEST(Rmse, ExcludesAndCountsNonFinitePixelsOfEitherImage) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Image a{4, 1, 3, {0, 0, 0, nan, 0, 0, 0, 0, inf, 1, 1, 1}};
  const Image b{4, 1, 3, {1, 1, 1, 0, 0, 0, 0, 0, inf, 1, 1, 1}};
  const RmseResult result = rmse(a, b);
  EXPECT_EQ(result.excludedPixels, 2u);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt(3.0 / 6));
  EXPECT_EQ(relmse(a, b).excludedPixels, 2u);
}

TEST(Rmse, OfImagesWithoutAFinitePixelIsNotANumber) {
  const Image a{1, 1, 3, {std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  EXPECT_TRUE(std::isnan(rmse(a, a).rmse));
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
