#include "metrics/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

constexpr double kSigma = 0.05;

// A smooth picture plus independent normal noise.
Image noisyImage(uint32_t seed, double sigma) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  Image image{96, 64, 3, {}};
  for (size_t i = 0; i < 96 * 64 * 3; ++i)
    image.pixels.push_back(static_cast<float>(0.4 + 0.2 * std::sin(static_cast<double>(i) * 0.01) + noise(random)));
  return image;
}

double floorOf(const std::vector<NoiseFloor>& floors, std::string_view metric) {
  for (const NoiseFloor& floor : floors)
    if (floor.metric == metric) return floor.score;
  return std::nan("");
}

// The mean of two halves of deviation s has the deviation s / sqrt(2); the floor of every metric must be what a perfect
// image scores against that mean. 18,432 samples: the standard error of a root mean square is 0.5 %.
TEST(NoiseFloor, IsWhatAPerfectImageScoresAgainstTheMean) {
  const Image a = noisyImage(1, kSigma), b = noisyImage(2, kSigma), perfect = noisyImage(0, 0);
  const auto floors = noiseFloors(a, b, metricList());
  EXPECT_NEAR(floorOf(floors, "rmse"), kSigma / std::sqrt(2.0), 0.02 * kSigma);

  Image mean = a;
  for (size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
  const PreparedReference reference("mean", {mean, Encoding::linear, {}});
  const ComparedImage test = reference.prepareTest("perfect", {perfect, Encoding::linear, {}});
  for (const Metric& metric : metricList()) {
    if (std::min(mean.width, mean.height) < metric.smallestSide) continue;
    const double score = mainScore(metric, metric.measure(reference, test, false));
    // relmse divides by the noisy mean, which a perfect image's error depends on and a half's difference does not.
    EXPECT_NEAR(floorOf(floors, metric.name) / score, 1, metric.name == "relmse" ? 0.15 : 0.05) << metric.name;
  }
}

TEST(NoiseFloor, LeavesOutMetricsThatTheImageIsTooSmallFor) {
  const Image small{12, 12, 3, std::vector<float>(432, 0.5f)};
  const auto floors = noiseFloors(small, small, metricList());
  EXPECT_TRUE(std::isnan(floorOf(floors, "hdrvdp2")));
  EXPECT_EQ(floorOf(floors, "rmse"), 0.0);
  EXPECT_EQ(floorOf(floors, "ssim"), 1.0);
}

TEST(NoiseFloor, RefusesHalvesOfDifferentSizes) {
  EXPECT_THROW(noiseFloors(noisyImage(1, kSigma), Image{1, 1, 3, {0, 0, 0}}, metricList()), std::invalid_argument);
}

}  // namespace
}  // namespace wavecrest
