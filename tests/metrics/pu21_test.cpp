#include "metrics/pu21.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

using test::lightOf;

Image constantLight(uint32_t width, uint32_t height, float value) {
  return {width, height, 3, std::vector<float>(size_t{width} * height * 3, value)};
}

// Light up to 100 cd/m2, and up to 800.
TEST(Pu21, MatchesGoldenFiguresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      const Image reference = lightOf(pair.reference), test = lightOf(pair.test);
      for (const std::string stops : {"", "_3_stops"}) {
        SCOPED_TRACE(pair.name + stops + " " + std::string(toString(isa)));
        const auto golden = [&](const std::string& figure) {
          return test::goldenFigure("pu21.json", pair.name, figure + stops);
        };
        const PreparedPu21 prepared(reference, stops.empty() ? 0 : 3, isa);
        const Pu21PsnrResult psnr = prepared.psnr(test);
        EXPECT_NEAR(psnr.colour, golden("psnr"), 1e-5);
        EXPECT_NEAR(psnr.luminance, golden("psnr_y"), 1e-5);
        EXPECT_NEAR(prepared.ssim(test).mean, golden("ssim"), 1e-5);
      }
    }
  }
}

// What gfxdisp/pu21 says of its range: 100 cd/m2 is 256 within half a unit, 0.005 is 0, 10000 is 595.4.
TEST(Pu21, DistancesOfConstantImagesAreThoseOfTheirCodes) {
  const auto distance = [](float a, float b) {
    const double psnr = PreparedPu21(constantLight(3, 2, a)).psnr(constantLight(3, 2, b)).colour;
    return 256 / std::pow(10, psnr / 20);
  };
  EXPECT_NEAR(distance(0.005f / 100, 1), 256, 0.5);
  EXPECT_NEAR(distance(0.005f / 100, 100), 595.4, 0.5);
  EXPECT_NEAR(distance(1, 200), distance(1, 100), 1e-3) << "light is clamped at 10000 cd/m2";
  EXPECT_NEAR(distance(1, 0), distance(1, -1), 1e-9) << "and at 0.005";
}

TEST(Pu21, OfIdenticalImagesEndsAtItsCeiling) {
  const Image image = lightOf(test::patternImage(37, 23));
  const PreparedPu21 prepared(image);
  EXPECT_EQ(prepared.psnr(image).colour, kPu21GreatestPsnr);
  EXPECT_EQ(prepared.psnr(image).luminance, kPu21GreatestPsnr);
  EXPECT_EQ(prepared.ssim(image).mean, 1.0);
}

TEST(Pu21, TakesASinglePixel) {
  const PreparedPu21 prepared(constantLight(1, 1, 0.5f));
  EXPECT_LT(prepared.ssim(constantLight(1, 1, 0.1f)).mean, 1);
  EXPECT_LT(prepared.psnr(constantLight(1, 1, 0.1f)).colour, 20);
}

TEST(Pu21, IsBitIdenticalForAnyNumberOfThreads) {
  const auto& pair = test::goldenPairs()[2];
  const PreparedPu21 prepared(lightOf(pair.reference));
  const Image test = lightOf(pair.test);
  const double psnr = prepared.psnr(test).colour, ssim = prepared.ssim(test).mean;
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.psnr(test).colour, psnr);
  EXPECT_EQ(prepared.ssim(test).mean, ssim);
}

TEST(Pu21, MapsHaveTheImagesSizeAndItsScores) {
  const auto& pair = test::goldenPairs()[2];
  const PreparedPu21 prepared(lightOf(pair.reference));
  const Image test = lightOf(pair.test);
  const Pu21PsnrResult psnr = prepared.psnr(test, true);
  const Pu21SsimResult ssim = prepared.ssim(test, true);
  ASSERT_EQ(psnr.map.size(), test.pixelCount());
  ASSERT_EQ(ssim.map.size(), test.pixelCount());
  double squares = 0, similarity = 0;
  for (const float v : psnr.map) squares += double{v} * double{v};
  for (const float v : ssim.map) similarity += double{v};
  const auto pixels = static_cast<double>(test.pixelCount());
  EXPECT_NEAR(10 * std::log10(256 * 256 / (squares / pixels)), psnr.colour, 1e-5);
  EXPECT_NEAR(similarity / pixels, ssim.mean, 1e-6);
}

}  // namespace
}  // namespace wavecrest
