#include "metrics/ssim.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

TEST(Ssim, MatchesGoldenFiguresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto golden = [&](const char* figure, auto... index) {
        return test::goldenFigure("ssim.json", pair.name, figure, index...);
      };
      const SsimResult result = PreparedSsim(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.mean, golden("ssim_mean"), 1e-6);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(result.channels[c], golden("ssim_rgb", c), 1e-6);
    }
  }
}

TEST(Ssim, OfIdenticalImagesIsExactlyOne) {
  const Image8 image = test::patternImage(37, 23);
  const SsimResult result = PreparedSsim(image).compare(image);
  EXPECT_EQ(result.mean, 1.0);
  EXPECT_EQ(result.luma, 1.0);
}

// Two different constants: the variances vanish and only the luminance term is left, a case in which single precision
// would lose all digits if it subtracted squares of codes.
TEST(Ssim, OfConstantImagesIsTheLuminanceTerm) {
  const double c1 = 6.5025;
  for (const auto& [x, y] : {std::pair{255, 254}, {0, 255}, {0, 0}, {200, 130}}) {
    const Image8 a{16, 14, std::vector<uint8_t>(16 * 14 * 3, static_cast<uint8_t>(x))};
    const Image8 b{16, 14, std::vector<uint8_t>(16 * 14 * 3, static_cast<uint8_t>(y))};
    const double expected = (2.0 * x * y + c1) / (double(x) * x + double(y) * y + c1);
    EXPECT_NEAR(PreparedSsim(a).compare(b).mean, expected, 1e-6) << x << " against " << y;
  }
}

TEST(Ssim, IsSymmetric) {
  const auto& pair = test::goldenPairs()[0];
  const double forward = PreparedSsim(pair.reference).compare(pair.test).mean;
  EXPECT_NEAR(PreparedSsim(pair.test).compare(pair.reference).mean, forward, 1e-6);
}

TEST(Ssim, FallsWithAddedNoise) {
  const Image8 image = test::patternImage(64, 48);
  const PreparedSsim prepared(image);
  double last = 1;
  for (int amplitude : {2, 5, 10, 20, 40, 80}) {
    const double score = prepared.compare(test::withNoise(image, amplitude)).mean;
    EXPECT_LT(score, last) << amplitude;
    last = score;
  }
}

TEST(Ssim, TakesTheSmallestSizeAndRefusesBelow) {
  const Image8 smallest = test::patternImage(11, 11);
  EXPECT_EQ(PreparedSsim(smallest).compare(smallest).mean, 1.0);
  EXPECT_THROW(PreparedSsim(test::patternImage(10, 200)), std::invalid_argument);
  EXPECT_THROW(PreparedSsim(test::patternImage(1, 1)), std::invalid_argument);
}

TEST(Ssim, IsBitIdenticalForAnyNumberOfThreads) {
  const auto& pair = test::goldenPairs()[2];
  const PreparedSsim prepared(pair.reference);
  const double parallel = prepared.compare(pair.test).mean;
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.compare(pair.test).mean, parallel);
}

TEST(Ssim, MapHasTheImagesSizeAndTheScoreAsItsInnerMean) {
  const auto& pair = test::goldenPairs()[2];
  const SsimResult result = PreparedSsim(pair.reference).compare(pair.test, true);
  const size_t width = pair.reference.width, height = pair.reference.height;
  ASSERT_EQ(result.map.size(), width * height);
  double sum = 0;
  for (size_t y = 5; y < height - 5; ++y)
    for (size_t x = 5; x < width - 5; ++x) sum += double{result.map[y * width + x]};
  EXPECT_NEAR(sum / double((width - 10) * (height - 10)), result.mean, 1e-6);
}

// The definition, window by window in double.
double ssimByDefinition(const Image8& x, const Image8& y, size_t channel) {
  double weights[11], total = 0, sum = 0;
  for (int i = 0; i < 11; ++i) total += weights[i] = std::exp(-(i - 5) * (i - 5) / (2 * 1.5 * 1.5));
  for (size_t top = 0; top + 11 <= x.height; ++top) {
    for (size_t left = 0; left + 11 <= x.width; ++left) {
      double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
      for (size_t i = 0; i < 121; ++i) {
        const size_t at = ((top + i / 11) * x.width + left + i % 11) * 3 + channel;
        const double w = weights[i / 11] * weights[i % 11] / (total * total), a = x.pixels[at], b = y.pixels[at];
        mx += w * a;
        my += w * b;
        xx += w * a * a;
        yy += w * b * b;
        xy += w * a * b;
      }
      const double vx = xx - mx * mx, vy = yy - my * my, cxy = xy - mx * my;
      sum += (2 * mx * my + 6.5025) * (2 * cxy + 58.5225) / ((mx * mx + my * my + 6.5025) * (vx + vy + 58.5225));
    }
  }
  return sum / static_cast<double>((x.width - 10) * (x.height - 10));
}

// Sizes whose rows have equal lengths as colour or luma follow each other, as work space is kept between comparisons.
TEST(Ssim, MatchesTheDefinitionAtOddSizes) {
  for (const Isa isa : availableIsas()) {
    for (const auto& [width, height] :
         {std::pair{11u, 11u}, {33u, 12u}, {12u, 40u}, {99u, 13u}, {33u, 50u}, {43u, 11u}, {21u, 12u}}) {
      const Image8 image = test::patternImage(width, height), noisy = test::withNoise(image, 50);
      const SsimResult result = PreparedSsim(image, isa).compare(noisy);
      for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(result.channels[c], ssimByDefinition(image, noisy, c), 1e-6)
            << toString(isa) << " " << width << "x" << height << " channel " << c;
      }
    }
  }
}

// All three channels replaced by the luma of ITU-R BT.709. The library's weights are whole 65536ths: a luma in two
// hundred or so rounds to the other code, which moves the mean by some 1e-5.
Image8 lumaOf(const Image8& image) {
  Image8 luma{image.width, image.height, {}};
  for (size_t i = 0; i < image.pixels.size(); i += 3) {
    const double y = 0.2126 * image.pixels[i] + 0.7152 * image.pixels[i + 1] + 0.0722 * image.pixels[i + 2];
    luma.pixels.insert(luma.pixels.end(), 3, static_cast<uint8_t>(std::lround(y)));
  }
  return luma;
}

TEST(Ssim, LumaIsTheScoreOfTheLumaAlone) {
  const auto& pair = test::goldenPairs()[0];
  const SsimResult result = PreparedSsim(pair.reference).compare(pair.test);
  EXPECT_NEAR(result.luma, ssimByDefinition(lumaOf(pair.reference), lumaOf(pair.test), 0), 5e-5);
  EXPECT_GT(std::abs(result.luma - result.mean), 1e-3) << "the pair must tell luma from the mean of the channels";
}

TEST(Ssim, FallsWithAShiftOfTheImage) {
  const Image8 image = test::patternImage(80, 40);
  const auto window = [&](uint32_t shift) {
    Image8 part{60, 40, {}};
    for (uint32_t y = 0; y < 40; ++y) {
      const auto row = image.pixels.begin() + 3 * (80 * y + shift);
      part.pixels.insert(part.pixels.end(), row, row + 180);
    }
    return part;
  };
  const PreparedSsim prepared(window(0));
  const double one = prepared.compare(window(1)).mean, three = prepared.compare(window(3)).mean;
  EXPECT_LT(one, 1.0);
  EXPECT_LT(three, one);
}

}  // namespace
}  // namespace wavecrest
