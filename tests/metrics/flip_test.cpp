#include "metrics/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <stdexcept>

#include "metrics/flip_model.h"
#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

// The reference implementation works in single precision: its own digits end at 2e-5.
constexpr double kTolerance = 2e-5;

TEST(Flip, RefusesMorePixelsPerDegreeThanItsFiltersHold) {
  EXPECT_NO_THROW(FlipModel(400, bestIsa()));
  EXPECT_THROW(FlipModel(600, bestIsa()), std::invalid_argument);
}

TEST(Flip, MatchesGoldenMeansAndMaximaOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      if (isa != bestIsa() && pair.test.width > 512) continue;  // the largest pair adds nothing but time
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto golden = [&](const char* figure, auto... index) {
        return test::goldenFigure("flip.json", pair.name, figure, index...);
      };
      const FlipResult result = PreparedFlip(pair.reference, kFlipPixelsPerDegree, isa).compare(pair.test, true);
      EXPECT_NEAR(result.mean, golden("flip_map_mean_double"), kTolerance);
      EXPECT_NEAR(*std::max_element(result.map.begin(), result.map.end()), golden("flip_map_max"), 5 * kTolerance);
    }
  }
}

TEST(Flip, OfIdenticalImagesIsZero) {
  const Image8 image = test::patternImage(40, 30);
  EXPECT_EQ(PreparedFlip(image).compare(image).mean, 0.0);
}

TEST(Flip, IsSymmetric) {
  const auto& pair = test::goldenPairs()[0];
  const double forward = PreparedFlip(pair.reference).compare(pair.test).mean;
  EXPECT_NEAR(PreparedFlip(pair.test).compare(pair.reference).mean, forward, 1e-6);
}

TEST(Flip, RisesWithAddedNoise) {
  const Image8 image = test::patternImage(64, 48);
  const PreparedFlip prepared(image);
  double last = 0;
  for (int amplitude : {2, 5, 10, 20, 40, 80}) {
    const double score = prepared.compare(test::withNoise(image, amplitude)).mean;
    EXPECT_GT(score, last) << amplitude;
    last = score;
  }
}

TEST(Flip, RisesWithAShiftOfTheImage) {
  const Image8 image = test::patternImage(80, 40);
  const auto window = [&](uint32_t shift) {
    Image8 part{60, 40, {}};
    for (uint32_t y = 0; y < 40; ++y) {
      const auto row = image.pixels.begin() + 3 * (80 * y + shift);
      part.pixels.insert(part.pixels.end(), row, row + 180);
    }
    return part;
  };
  const PreparedFlip prepared(window(0));
  const double one = prepared.compare(window(1)).mean;
  EXPECT_GT(one, 0.0);
  EXPECT_GT(prepared.compare(window(3)).mean, one);
}

TEST(Flip, OfBlackAndOtherConstantImagesRisesWithTheirDistance) {
  const auto constant = [](uint8_t code) { return Image8{9, 7, std::vector<uint8_t>(9 * 7 * 3, code)}; };
  const PreparedFlip black(constant(0));
  double last = black.compare(constant(0)).mean;
  EXPECT_EQ(last, 0.0);
  for (const int level : {20, 80, 160, 255}) {
    const auto code = static_cast<uint8_t>(level);
    const FlipResult result = black.compare(constant(code), true);
    EXPECT_GT(result.mean, last);
    EXPECT_NEAR(result.map[0], result.map[31], 1e-6) << "edges are no different from the middle";
    last = result.mean;
  }
}

TEST(Flip, OfTheFarthestColoursIsOne) {
  Image8 green{8, 8, {}}, blue = green;
  for (int i = 0; i < 64; ++i) {
    green.pixels.insert(green.pixels.end(), {0, 255, 0});
    blue.pixels.insert(blue.pixels.end(), {0, 0, 255});
  }
  EXPECT_NEAR(PreparedFlip(green).compare(blue).mean, 1.0, 1e-5);
}

TEST(Flip, TakesAnySizeDownToOnePixel) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 40u}, {17u, 3u}, {2u, 2u}}) {
    const Image8 image = test::patternImage(width, height);
    const double score = PreparedFlip(image).compare(test::withNoise(image, 60)).mean;
    EXPECT_GT(score, 0.0);
    EXPECT_LE(score, 1.0);
  }
}

TEST(Flip, IsBitIdenticalForAnyNumberOfThreads) {
  const auto& pair = test::goldenPairs()[2];
  const PreparedFlip prepared(pair.reference);
  const double parallel = prepared.compare(pair.test).mean;
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.compare(pair.test).mean, parallel);
}

// ---- HDR ------------------------------------------------------------------------------------------------------------

// Light over twelve stops, with structure. The figures below come from flip-evaluator 1.7, evaluate(..., "HDR"), on
// the same formulas in numpy.
Image hdrPattern(uint32_t width, uint32_t height, float noise) {
  Image image{width, height, 3, {}};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const float random = static_cast<float>((x * 37 + y * 101 + x * y * 7) % 41) / 41.0f - 0.5f;
      const float factor = 1 + noise * random, checker = static_cast<float>((x / 7 + y / 5) % 2);
      const float red = std::exp2(static_cast<float>(x) * 12 / static_cast<float>(width) - 6) * (1 + 0.5f * checker);
      const float green = std::exp2(static_cast<float>(y) * 12 / static_cast<float>(height) - 6);
      const float blue = 0.25f + 0.2f * static_cast<float>((x + 2 * y) % 23) / 23;
      for (float v : {red, green, blue}) image.pixels.push_back(v * factor);
    }
  }
  return image;
}

TEST(HdrFlip, MatchesFlipEvaluator) {
  const PreparedHdrFlip even(hdrPattern(96, 64, 0));
  ASSERT_EQ(even.exposures().size(), 5u);
  EXPECT_NEAR(even.exposures().front(), -4.7978001, 1e-5);
  EXPECT_NEAR(even.exposures().back(), -0.3355648, 1e-5);
  EXPECT_NEAR(even.compare(hdrPattern(96, 64, 0.4f)).mean, 0.0730748, kTolerance);
  const PreparedHdrFlip odd(hdrPattern(61, 47, 0));
  EXPECT_NEAR(odd.exposures().back(), -0.3444040, 1e-5);
  EXPECT_NEAR(odd.compare(hdrPattern(61, 47, 0.4f)).mean, 0.0755817, kTolerance);
}

TEST(HdrFlip, SeesDifferencesBeyondTheDisplayRange) {
  const Image reference = hdrPattern(48, 32, 0);
  Image test = reference;
  for (float& v : test.pixels)
    if (v > 4) v *= 1.5f;
  EXPECT_GT(PreparedHdrFlip(reference).compare(test).mean, 0.005);
}

TEST(HdrFlip, TakesBlackAndConstantImages) {
  const Image black{9, 7, 3, std::vector<float>(9 * 7 * 3, 0.0f)};
  Image grey = black;
  for (float& v : grey.pixels) v = 0.18f;
  EXPECT_EQ(PreparedHdrFlip(black).compare(black).mean, 0.0);
  EXPECT_EQ(PreparedHdrFlip(grey).compare(grey).mean, 0.0);
  EXPECT_GT(PreparedHdrFlip(grey).compare(black).mean, 0.1);
  EXPECT_GT(PreparedHdrFlip(black).compare(grey).mean, 0.1) << "a black reference has an exposure too";
}

// The last exposures show the median: a difference there is seen by features that are not kept.
TEST(HdrFlip, SeesDifferencesAtEveryExposure) {
  Image reference{24, 16, 3, std::vector<float>(24 * 16 * 3, 0.01f)};
  reference.pixels[0] = 1e30f;
  Image test = reference;
  for (size_t i = 300; i < 600; ++i) test.pixels[i] *= 8;
  const PreparedHdrFlip prepared(reference);
  ASSERT_GT(prepared.exposures().size(), PreparedHdrFlip::kKeptExposures);
  EXPECT_EQ(prepared.compare(reference).mean, 0.0);
  EXPECT_GT(prepared.compare(test).mean, 0.01);
}

TEST(HdrFlip, TakesAnyLight) {
  Image reference = hdrPattern(24, 16, 0), test = reference;
  test.pixels[5] = 3e38f;
  test.pixels[50] = -2;
  const double score = PreparedHdrFlip(reference).compare(test).mean;
  EXPECT_TRUE(score > 0 && score < 1) << score;
}

}  // namespace
}  // namespace wavecrest
