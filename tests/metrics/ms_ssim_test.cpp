#include "metrics/ms_ssim.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "tests/effort.h"
#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

bool isLargeEnough(const test::GoldenPair& pair) {
  return std::min(pair.reference.width, pair.reference.height) >= kMsSsimSmallestSide;
}

TEST(MsSsim, MatchesGoldenFiguresOfAllPairsOnEveryIsa) {
  size_t pairs = 0;
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      if (!isLargeEnough(pair)) continue;
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto golden = [&](const char* figure, auto... index) {
        return test::goldenFigure("msssim.json", pair.name, figure, index...);
      };
      const MsSsimResult result = PreparedMsSsim(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.mean, golden("wang_mean"), 1e-6);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(result.channels[c], golden("wang_rgb", c), 1e-6);
      // The package keeps its window in single precision, and treats sides of odd length differently.
      const bool evenScales = pair.reference.width % 16 == 0 && pair.reference.height % 16 == 0;
      EXPECT_NEAR(result.mean, golden("pytorch_msssim"), evenScales ? 1e-5 : 1e-2);
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, effort(4, 3) * availableIsas().size());
}

TEST(MsSsim, OfIdenticalImagesIsExactlyOne) {
  const Image8 image = test::patternImage(163, 161);
  EXPECT_EQ(PreparedMsSsim(image).compare(image).mean, 1.0);
}

TEST(MsSsim, RefusesImagesWhoseCoarsestScaleHasNoWindow) {
  EXPECT_THROW(PreparedMsSsim(test::patternImage(160, 400)), std::invalid_argument);
  EXPECT_THROW(PreparedMsSsim(test::patternImage(400, 160)), std::invalid_argument);
}

// The negative of an image correlates with it negatively at every scale.
TEST(MsSsim, OfANegativeIsZero) {
  const Image8 image = test::patternImage(170, 170);
  Image8 negative = image;
  for (uint8_t& code : negative.pixels) code = static_cast<uint8_t>(255 - code);
  EXPECT_EQ(PreparedMsSsim(image).compare(negative).mean, 0.0);
}

TEST(MsSsim, IsBitIdenticalForAnyNumberOfThreads) {
  const auto& pair = test::goldenPairs()[2];
  const PreparedMsSsim prepared(pair.reference);
  const double parallel = prepared.compare(pair.test).mean;
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.compare(pair.test).mean, parallel);
}

TEST(MsSsim, MapIsLowWhereImagesDifferAndOneFarFromThere) {
  const Image8 image = test::patternImage(320, 320);
  Image8 changed = image;
  for (uint32_t y = 40; y < 60; ++y)
    for (uint32_t x = 40; x < 60; ++x)
      for (uint32_t c = 0; c < 3; ++c) changed.pixels[(y * 320 + x) * 3 + c] = static_cast<uint8_t>(x % 2 * 255);
  const PreparedMsSsim prepared(image);
  const MsSsimResult result = prepared.compare(changed, true);
  ASSERT_EQ(result.map.size(), 320u * 320u);
  EXPECT_LT(result.map[50 * 320 + 50], 0.6f);
  EXPECT_EQ(result.map[300 * 320 + 300], 1.0f);
  EXPECT_EQ(result.mean, prepared.compare(changed).mean) << "asking for the map changes no score";
}

}  // namespace
}  // namespace wavecrest
