// Comparisons of the interface: exposures, sRGB values and maps that are refused, and how many bits the codes of images
// have.
#include "wavecrest/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/refusal.h"
#include "wavecrest/error.h"

namespace wavecrest::api {
namespace {

// 2 x 2 pixels of one value.
Image constant(float value, bool srgb) {
  return {.width = 2, .height = 2, .pixels = std::vector(12, value), .srgb = srgb};
}

double rmse(const Image& reference, const Image& test) {
  return Reference(reference).compare(test, {"rmse"}).results.front().score;
}

TEST(Comparisons, exposuresOutOfRangeAreRefused) {
  const auto refusal = [](double exposure) {
    return refusalOf<Error>([&] { Reference(constant(0.5f, false), {.exposure = exposure}); });
  };
  EXPECT_EQ(refusal(std::nan("")), "--exposure nan: expected a number from -100 to 100");
  EXPECT_EQ(refusal(1e4), "--exposure 10000: expected a number from -100 to 100");
  EXPECT_EQ(refusalOf<Error>([] { srgbCodes(constant(0.5f, false), -101); }),
            "--exposure -101: expected a number from -100 to 100");
  EXPECT_NO_THROW(Reference(constant(0.5f, false), {.exposure = -100}));
}

TEST(Comparisons, sRgbValuesOutsideTheirRangeAreRefused) {
  for (const float wrong : {1.2f, -0.1f, std::nanf("")}) {
    Image image = constant(0.5f, true);
    image.pixels[7] = wrong;
    EXPECT_EQ(refusalOf<Error>([&] { rmse(constant(0.5f, true), image); }),
              "test: sRGB value outside 0..1; expected codes over 255 or 65535");
    EXPECT_EQ(refusalOf<Error>([&] { rmse(image, constant(0.5f, true)); }),
              "reference: sRGB value outside 0..1; expected codes over 255 or 65535");
    image.srgb = false;
    EXPECT_NO_THROW(rmse(constant(0.5f, false), image)) << "linear light";
  }
}

// Whole codes of 8 bits differ by 1/255, their values as floats by 3e-8 more or less.
TEST(Comparisons, codesOf8BitsAreComparedExactly) {
  EXPECT_NEAR(rmse(constant(128 / 255.0f, true), constant(129 / 255.0f, true)), 1 / 255.0, 1e-12);
}

// As 8-bit codes both would be 128.
TEST(Comparisons, codesOf16BitsKeepTheirPrecision) {
  const Image a = constant(32768 / 65535.0f, true), b = constant(32828 / 65535.0f, true);
  EXPECT_NEAR(rmse(a, b), 60 / 65535.0, 1e-7);
  EXPECT_NEAR(rmse(constant(128 / 255.0f, true), b), 128 / 255.0 - 32828 / 65535.0, 1e-7);
}

TEST(FalseColours, areOfOneValueForEachPixel) {
  EXPECT_EQ(falseColours({0, 0, 1, 1}, 2, 2, 1).size(), 12u);
  EXPECT_EQ(refusalOf<Error>([] {
              falseColours({0, 0, 1}, 2, 2, 1);
            }),
            "map: has 3 values; expected one for each of its 2 x 2 pixels, and at least one");
  EXPECT_THROW(falseColours({}, 0, 0, 1), Error);
}

}  // namespace
}  // namespace wavecrest::api
