#include "metrics/hdrvdp2/hdrvdp2.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <array>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

// Two orders tighter than the score needs: single precision in filters moves Q by less than 1e-6.
constexpr double kQTolerance = 1e-6, kMosTolerance = 1e-4;

TEST(HdrVdp2, MatchesGoldenScoresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      if (isa != bestIsa() && pair.test.width > 512) continue;  // the largest pair adds nothing but time
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto golden = [&](const char* figure, auto... index) {
        return test::goldenFigure("hdrvdp2.json", pair.name, figure, index...);
      };
      const HdrVdp2Result result = PreparedHdrVdp2(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.q, golden("Q"), kQTolerance);
      EXPECT_NEAR(result.qMos, golden("Q_MOS"), kMosTolerance);
    }
  }
}

// The ceiling for each number of levels, from the specification of the original's pooling.
TEST(HdrVdp2, OfIdenticalImagesIsTheCeilingOfItsLevels) {
  struct Ceiling {
    uint32_t width, height;
    double q;
  };
  for (const auto& [width, height, q] : {Ceiling{70, 40, -6.233005743331},
                                         {100, 70, -4.688392190063},
                                         {150, 140, -3.648369294268},
                                         {333, 300, -2.986410893266}}) {
    const Image8 image = test::patternImage(width, height);
    EXPECT_NEAR(PreparedHdrVdp2(image).compare(image).q, q, 1e-11) << width;
  }
}

// Single precision may move this one more than others: the differences are tiny everywhere but at one spot.
TEST(HdrVdp2, OfOneChangedCodeIsJustBelowTheCeiling) {
  const auto& pair = test::goldenPairs()[0];
  Image8 changed = pair.reference;
  uint8_t& code = changed.pixels[(64 * 128 + 64) * 3 + 1];
  code = static_cast<uint8_t>(code == 255 ? 254 : code + 1);
  const double q = PreparedHdrVdp2(pair.reference).compare(changed).q;
  EXPECT_GT(q, -4.688392190063);
  EXPECT_LT(q, -4.4);
}

TEST(HdrVdp2, IsNearlySymmetric) {
  const auto& pair = test::goldenPairs()[1];
  const double forward = PreparedHdrVdp2(pair.reference).compare(pair.test).q;
  EXPECT_NEAR(PreparedHdrVdp2(pair.test).compare(pair.reference).q, forward, 1e-6);
}

TEST(HdrVdp2, FallsWithAddedNoise) {
  const Image8 image = test::patternImage(120, 90);
  const PreparedHdrVdp2 prepared(image);
  double last = prepared.compare(image).qMos;
  for (int amplitude : {2, 5, 10, 20, 40, 80}) {
    const double score = prepared.compare(test::withNoise(image, amplitude)).qMos;
    EXPECT_LT(score, last) << amplitude;
    last = score;
  }
}

TEST(HdrVdp2, FallsWithTheShiftOfAnImage) {
  const Image8 image = test::patternImage(130, 90);
  const auto window = [&](uint32_t shift) {
    Image8 part{100, 90, {}};
    for (uint32_t y = 0; y < 90; ++y) {
      const auto row = image.pixels.begin() + 3 * (130 * y + shift);
      part.pixels.insert(part.pixels.end(), row, row + 300);
    }
    return part;
  };
  const PreparedHdrVdp2 prepared(window(0));
  const double same = prepared.compare(window(0)).qMos, one = prepared.compare(window(1)).qMos;
  EXPECT_GT(same, one);
  EXPECT_GT(one, prepared.compare(window(3)).qMos);
}

TEST(HdrVdp2, TakesBlackAndConstantImages) {
  const auto constant = [](uint8_t code) { return Image8{33, 17, std::vector<uint8_t>(33 * 17 * 3, code)}; };
  const PreparedHdrVdp2 black(constant(0));
  const double same = black.compare(constant(0)).q, grey = black.compare(constant(90)).q;
  EXPECT_TRUE(std::isfinite(same) && std::isfinite(grey));
  EXPECT_LT(same, grey);
}

TEST(HdrVdp2, TakesTheSmallestSizeAndRefusesBelow) {
  const Image8 smallest = test::patternImage(17, 17);
  EXPECT_TRUE(std::isfinite(PreparedHdrVdp2(smallest).compare(test::withNoise(smallest, 30)).q));
  EXPECT_THROW(PreparedHdrVdp2(test::patternImage(16, 400)), std::invalid_argument);
}

TEST(HdrVdp2, IsBitIdenticalForAnyNumberOfThreadsAndConcurrentCallers) {
  const auto& pair = test::goldenPairs()[0];
  const PreparedHdrVdp2 prepared(pair.reference);
  const double expected = prepared.compare(pair.test).q;
  std::array<double, 8> scores{};
  tbb::parallel_for(size_t{0}, scores.size(), [&](size_t i) { scores[i] = prepared.compare(pair.test).q; });
  for (double score : scores) EXPECT_EQ(score, expected);
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.compare(pair.test).q, expected);
}

TEST(HdrVdp2, ProbabilityIsHighWhereImagesDifferAndZeroWhereTheyAgree) {
  const Image8 image = test::patternImage(128, 96);
  Image8 changed = image;
  for (uint32_t y = 30; y < 50; ++y)
    for (uint32_t x = 20; x < 40; ++x)
      for (uint32_t c = 0; c < 3; ++c)
        changed.pixels[(y * 128 + x) * 3 + c] = static_cast<uint8_t>(x % 4 < 2 ? 0 : 255);
  const PreparedHdrVdp2 prepared(image);
  const HdrVdp2Result result = prepared.compare(changed, true);
  ASSERT_EQ(result.probability.size(), 128u * 96u);
  EXPECT_GT(result.probability[40 * 128 + 30], 0.99f);
  EXPECT_LT(result.probability[80 * 128 + 110], 0.05f);
  EXPECT_EQ(result.q, prepared.compare(changed).q) << "asking for the map changes no score";
  for (float p : prepared.compare(image, true).probability) ASSERT_EQ(p, 0.0f);
}

}  // namespace
}  // namespace wavecrest
