#include "metrics/ssim.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

TEST(Ssim, MatchesGoldenFiguresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto figures = test::goldenFigures("ssim.json", pair.name);
      const SsimResult result = PreparedSsim(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.mean, figures["ssim_mean"], 1e-6);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(result.channels[c], figures["ssim_rgb"][c], 1e-6);
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

}  // namespace
}  // namespace wavecrest
