// Bias and variance are told apart, whatever noise the reference has.
#include "bench/campaign/bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "metrics/image/image_io.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

Image constant(uint32_t width, uint32_t height, float value) {
  return {.width = width, .height = height, .channels = 3, .pixels = std::vector<float>(3 * width * height, value)};
}

TEST(ErrorParts, areThoseOfTheDefinition) {
  // Errors against A = 1.5: 1.5 and -0.5; against B = 0.5: 2.5 and 0.5.
  const Reference reference{
      .mean = constant(1, 1, 1), .difference = constant(1, 1, 0.5f), .info = {}, .noiseFloors = {}};
  const ErrorParts parts = errorParts(std::vector{constant(1, 1, 3), constant(1, 1, 1)}, reference);
  EXPECT_DOUBLE_EQ(parts.meanSquareError, (1.5 * 2.5 + -0.5 * 0.5) / 2);
  EXPECT_DOUBLE_EQ(parts.biasSquared, (1.5 * 0.5 + -0.5 * 2.5) / 2);
  EXPECT_DOUBLE_EQ(parts.variance, parts.meanSquareError - parts.biasSquared);
}

TEST(UnbiasedMse, isTheMeanProductOfTheErrorsAgainstTheHalves) {
  const Reference reference{
      .mean = constant(1, 1, 1), .difference = constant(1, 1, 0.5f), .info = {}, .noiseFloors = {}};
  EXPECT_DOUBLE_EQ(*unbiasedMse(constant(1, 1, 3), reference), 1.5 * 2.5);
  EXPECT_DOUBLE_EQ(*unbiasedMse(constant(1, 1, 1), reference), -0.5 * 0.5) << "less than the reference's own noise";
  Image bad = constant(1, 1, 3);
  bad.pixels[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DOUBLE_EQ(*unbiasedMse(bad, reference), 1.5 * 2.5);
  EXPECT_FALSE(unbiasedMse(bad, {.mean = constant(1, 1, 1), .difference = {}, .info = {}, .noiseFloors = {}}));
}

TEST(ErrorParts, varianceIsTheVarianceOverSeeds) {
  const Reference plain{.mean = constant(1, 1, 1), .difference = {}, .info = {}, .noiseFloors = {}};
  const ErrorParts parts = errorParts(std::vector{constant(1, 1, 4), constant(1, 1, 2), constant(1, 1, 3)}, plain);
  EXPECT_DOUBLE_EQ(parts.variance, 1);  // of 4, 2, 3
}

// Truth 1, bias 0.3, noise of deviation 0.5; halves of the reference with noise of 0.4. Sums over 60,000 samples: the
// standard error of each part is below 0.005, the tolerance four of them.
TEST(ErrorParts, neitherContainsTheReferencesNoise) {
  constexpr uint32_t kSide = 141;
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  const auto noisy = [&](float mean, float deviation) {
    Image image = constant(kSide, kSide, mean);
    for (float& sample : image.pixels) sample += deviation * normal(random);
    return image;
  };
  const Image a = noisy(1, 0.4f), b = noisy(1, 0.4f);
  Reference reference{.mean = a, .difference = a, .info = {}, .noiseFloors = {}};
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    reference.mean.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
    reference.difference->pixels[i] = 0.5f * (a.pixels[i] - b.pixels[i]);
  }
  const ErrorParts parts = errorParts(std::vector{noisy(1.3f, 0.5f), noisy(1.3f, 0.5f), noisy(1.3f, 0.5f)}, reference);
  EXPECT_NEAR(parts.biasSquared, 0.09, 0.02);
  EXPECT_NEAR(parts.variance, 0.25, 0.02);
  EXPECT_NEAR(parts.meanSquareError, 0.34, 0.02);
}

TEST(ErrorParts, samplesThatAreNoNumbersAreLeftOut) {
  const Reference reference{.mean = constant(2, 1, 0), .difference = {}, .info = {}, .noiseFloors = {}};
  std::vector<Image> images{constant(2, 1, 2), constant(2, 1, 2)};
  images[1].pixels[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_DOUBLE_EQ(errorParts(images, reference).meanSquareError, 4);
}

TEST(MeasureBiases, takesTheSnapshotsThatAllSeedsHave) {
  const test::TemporaryFolder folder;
  const Reference reference{.mean = constant(2, 2, 1), .difference = {}, .info = {}, .noiseFloors = {}};
  const auto snapshot = [&](unsigned number, const std::string& name, float value) {
    if (!name.empty()) writeExr(folder.path(name), constant(2, 2, value));
    return SnapshotRecord{number, 0.5, 1, name.empty() ? "" : folder.path(name)};
  };
  RunRecord first{.scene = "s", .method = "pt", .seed = 1}, second{.scene = "s", .method = "pt", .seed = 2};
  first.snapshots = {snapshot(0, "", 0), snapshot(1, "a.exr", 3), snapshot(2, "c.exr", 3)};
  second.snapshots = {snapshot(0, "", 0), snapshot(1, "b.exr", 5)};
  const std::vector<const RunRecord*> runs{&first, &second};
  const std::vector<BiasRecord> biases = measureBiases(runs, reference);
  ASSERT_EQ(biases.size(), 1u);
  EXPECT_EQ(biases[0].number, 1u);
  EXPECT_EQ(biases[0].seeds, 2u);
  EXPECT_DOUBLE_EQ(biases[0].biasSquared, 8);  // errors 2 and 4
  EXPECT_DOUBLE_EQ(biases[0].variance, 2);
  EXPECT_TRUE(measureBiases(std::span(runs).first(1), reference).empty());
  std::filesystem::remove(folder.path("a.exr"));
  EXPECT_TRUE(measureBiases(runs, reference).empty()) << "an image that is no longer there";
}

}  // namespace
}  // namespace wavecrest
