#include "metrics/cvvdp/cvvdp.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "metrics/cvvdp/model.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/golden_json.h"

namespace wavecrest {
namespace {

TEST(Cvvdp, MatchesGoldenScoresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      if (isa != bestIsa() && pair.test.width > 512) continue;  // the largest pair adds nothing but time
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const CvvdpResult result = PreparedCvvdp(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.jod, test::goldenFigure("cvvdp.json", pair.name, "jod"), 1e-4);
    }
  }
}

// The original computes in single precision; differences near the threshold of 1e-5 are least certain.
TEST(Cvvdp, MatchesGoldenDifferencesOfEveryBand) {
  for (const auto& pair : test::goldenPairs()) {
    const auto golden = test::goldenFigures("cvvdp.json", pair.name);
    const CvvdpResult result = PreparedCvvdp(pair.reference).compare(pair.test);
    const auto rho = golden["rho"].get<std::vector<double>>();
    const std::vector<double> frequencies = cvvdp::bandFrequencies(pair.test.width, pair.test.height);
    ASSERT_EQ(frequencies.size(), rho.size());
    ASSERT_EQ(result.bands.size(), rho.size());
    for (size_t b = 0; b < rho.size(); ++b) {
      EXPECT_NEAR(frequencies[b], rho[b], 1e-9);
      for (size_t o = 0; o < 3; ++o) {
        const double expected = golden["q_per_ch"][o][b];
        EXPECT_NEAR(result.bands[b][o], expected, 1e-4 * expected + 1e-5) << pair.name << " " << b << " " << o;
      }
    }
  }
}

// The original stores its map in half precision: 1 in 2048 of each pixel.
TEST(Cvvdp, MatchesTheGoldenMap) {
  for (const auto& pair : test::goldenPairs()) {
    const CvvdpResult result = PreparedCvvdp(pair.reference).compare(pair.test, true);
    ASSERT_EQ(result.map.size(), pair.test.pixelCount());
    const double sum = std::accumulate(result.map.begin(), result.map.end(), 0.0);
    const double mean = test::goldenFigure("cvvdp.json", pair.name, "heatmap_mean");
    const double greatest = test::goldenFigure("cvvdp.json", pair.name, "heatmap_max");
    EXPECT_NEAR(sum / static_cast<double>(result.map.size()), mean, 5e-4 * mean) << pair.name;
    EXPECT_NEAR(*std::max_element(result.map.begin(), result.map.end()), greatest, 1e-3 * greatest) << pair.name;
  }
}

TEST(Cvvdp, NamesTheVersionAndDisplayOfItsGoldenScores) {
  EXPECT_EQ(test::goldenJson("cvvdp.json")["info_string"], kCvvdpConditions);
}

TEST(Cvvdp, OfIdenticalImagesIsTen) {
  const Image8 image = test::patternImage(70, 41);
  EXPECT_EQ(PreparedCvvdp(image).compare(image).jod, 10.0);
}

TEST(Cvvdp, FallsWithAddedNoise) {
  const Image8 image = test::patternImage(120, 90);
  const PreparedCvvdp prepared(image);
  double last = 10;
  for (int amplitude : {2, 5, 10, 20, 40, 80}) {
    const double score = prepared.compare(test::withNoise(image, amplitude)).jod;
    EXPECT_LT(score, last) << amplitude;
    last = score;
  }
}

TEST(Cvvdp, TakesTheSmallestSizeAndRefusesBelow) {
  const Image8 smallest = test::patternImage(16, 16);
  EXPECT_LT(PreparedCvvdp(smallest).compare(test::withNoise(smallest, 30)).jod, 10.0);
  EXPECT_THROW(PreparedCvvdp(test::patternImage(15, 400)), std::invalid_argument);
}

// Contrast is against each image's own mean, so the original too sees no difference between two constant greys.
TEST(Cvvdp, TakesBlackImagesAndSeesNoDifferenceBetweenConstants) {
  const Image8 black{33, 17, std::vector<uint8_t>(33 * 17 * 3)};
  Image8 grey = black;
  std::fill(grey.pixels.begin(), grey.pixels.end(), uint8_t{90});
  EXPECT_EQ(PreparedCvvdp(black).compare(black).jod, 10.0);
  EXPECT_NEAR(PreparedCvvdp(black).compare(grey).jod, 10.0, 1e-4);
  EXPECT_LT(PreparedCvvdp(black).compare(test::patternImage(33, 17)).jod, 9.0);
}

TEST(Cvvdp, IsBitIdenticalForAnyNumberOfThreadsAndConcurrentCallers) {
  const auto& pair = test::goldenPairs()[0];
  const PreparedCvvdp prepared(pair.reference);
  const double expected = prepared.compare(pair.test).jod;
  std::array<double, 8> scores{};
  tbb::parallel_for(size_t{0}, scores.size(), [&](size_t i) { scores[i] = prepared.compare(pair.test).jod; });
  for (double score : scores) EXPECT_EQ(score, expected);
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(prepared.compare(pair.test).jod, expected);
}

}  // namespace
}  // namespace wavecrest
