// Predictions on made-up renders, whose noise and bias are known.
#include "bench/recommend/prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 64;

Image scene() {
  Image image{.width = kSide, .height = kSide, .channels = 3, .pixels = std::vector<float>(3 * kSide * kSide)};
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        image.pixels[3 * (y * kSide + x) + c] = (x / 9 + y / 7) % 2 == 0 ? 0.2f : 0.6f;
      }
    }
  }
  return image;
}

// After one second noise has a deviation of kNoise, which falls with time to the power; four parts of a quarter of the
// time each have twice that of the whole where the power is a half.
constexpr double kNoise = 0.2;
Image noisy(double seconds, double bias, unsigned seed, double power = 0.5) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, kNoise / std::pow(seconds, power));
  Image image = scene();
  for (float& value : image.pixels) value = static_cast<float>(value * (1 + bias) + noise(random));
  return image;
}

Pilot pilotOf(double seconds, double bias) {
  Pilot pilot{.parts = {}, .seconds = seconds, .biased = bias != 0};
  for (unsigned part = 0; part < 4; ++part) pilot.parts[part] = noisy(seconds / 4, bias, part);
  return pilot;
}

double ssimOf(const PreparedReference& reference, const Image& image) {
  return reference.ssim().compare(reference.prepareTest("test", {image, Encoding::linear, {}}).codes).mean;
}

// The truth as four equal images: a reference without noise.
Pilot exact() {
  Pilot pilot{.parts = {}, .seconds = 1};
  for (Image& part : pilot.parts) part = scene();
  return pilot;
}

class PredictionTest : public testing::Test {
 protected:
  const PreparedReference truth_{"truth", {scene(), Encoding::linear, {}}};
  const PilotReference reference_{exact()};
};

TEST_F(PredictionTest, theImageAtThePredictedTimeHasTheQualityAskedFor) {
  const Prediction p = predict(reference_, pilotOf(1, 0), 0.95);
  ASSERT_TRUE(p.seconds);
  EXPECT_GT(*p.seconds, 2);  // or the test would say nothing about times to come
  EXPECT_NEAR(ssimOf(truth_, noisy(*p.seconds, 0, 77)), 0.95, 0.003);
  EXPECT_LE(p.interval.low, *p.seconds);
  EXPECT_GE(p.interval.high, *p.seconds);
  EXPECT_LT(p.interval.high / p.interval.low, 2.2);
  EXPECT_GT(p.ssimLimit, 0.999);
}

TEST_F(PredictionTest, noiseOfMergesFallsMoreSlowly) {
  Pilot pilot{.parts = {}, .seconds = 1};
  pilot.noiseExponent = noiseDecay(0.75);
  EXPECT_DOUBLE_EQ(pilot.noiseExponent, 0.375);
  for (unsigned part = 0; part < 4; ++part) pilot.parts[part] = noisy(0.25, 0, part, pilot.noiseExponent);
  const Prediction p = predict(reference_, pilot, 0.95);
  ASSERT_TRUE(p.seconds);
  EXPECT_GT(*p.seconds, 2);
  EXPECT_NEAR(ssimOf(truth_, noisy(*p.seconds, 0, 77, pilot.noiseExponent)), 0.95, 0.003);
}

// Few samples are bright, as those of caustics.
Image withFireflies(double seconds, unsigned seed) {
  std::mt19937 random(seed);
  constexpr double kRate = 0.1, kBright = 0.2;  // a second
  std::poisson_distribution<int> number(kRate * seconds);
  Image image = scene();
  for (float& value : image.pixels) value += static_cast<float>(kBright * (number(random) / seconds - kRate));
  return image;
}

TEST_F(PredictionTest, noiseOfFewBrightSamplesMaySpread) {
  Pilot pilot{.parts = {}, .seconds = 1};
  for (unsigned part = 0; part < 4; ++part) pilot.parts[part] = withFireflies(0.25, part);
  const Prediction even = predict(reference_, pilotOf(1, 0), 0.95);
  for (const double later : {4.0, 16.0}) {
    const Prediction p = predict(reference_, pilot, ssimOf(truth_, withFireflies(later, 77)));
    ASSERT_TRUE(p.seconds) << later;
    EXPECT_NEAR(std::log(*p.seconds / later), 0, std::log(1.3)) << later;
    EXPECT_LE(p.interval.low, later);
    EXPECT_GE(p.interval.high, later);
    EXPECT_GT(p.interval.high / *p.seconds, 1.2 * even.interval.high / *even.seconds) << later;
  }
}

TEST_F(PredictionTest, whatMergingBlursWithinBlocksIsExpected) {
  Pilot pilot = pilotOf(1, 0);
  pilot.biased = true;
  pilot.noiseExponent = noiseDecay(0.75);
  const Prediction left = predict(reference_, pilot, 0.95);
  pilot.biasExponent = biasDecay(0.75);
  const Prediction merged = predict(reference_, pilot, 0.95);
  ASSERT_TRUE(left.seconds && merged.seconds);
  EXPECT_GT(*merged.seconds, 1.2 * *left.seconds);
  EXPECT_DOUBLE_EQ(merged.interval.low, left.interval.low);
  EXPECT_GT(merged.interval.high, 1.5 * left.interval.high);
}

TEST_F(PredictionTest, whatIsDoneOnceIsAddedToTheTime) {
  Pilot pilot = pilotOf(1, 0);
  const Prediction without = predict(reference_, pilot, 0.95);
  pilot.onceSeconds = 3;
  const Prediction with = predict(reference_, pilot, 0.95);
  ASSERT_TRUE(without.seconds && with.seconds);
  EXPECT_DOUBLE_EQ(*with.seconds, *without.seconds + 3);
  EXPECT_DOUBLE_EQ(with.interval.low, without.interval.low + 3);
  EXPECT_DOUBLE_EQ(with.interval.high, without.interval.high + 3);
}

TEST_F(PredictionTest, doesNotDependOnHowLongThePilotWas) {
  const Prediction brief = predict(reference_, pilotOf(0.5, 0), 0.95);
  const Prediction longer = predict(reference_, pilotOf(4, 0), 0.95);
  ASSERT_TRUE(brief.seconds && longer.seconds);
  EXPECT_NEAR(std::log(*brief.seconds / *longer.seconds), 0, 0.1);
}

TEST_F(PredictionTest, aBiasThatStaysIsNeverOvercome) {
  const Prediction p = predict(reference_, pilotOf(4, -0.6), 0.95);
  EXPECT_FALSE(p.seconds);
  EXPECT_LT(p.ssimLimit, 0.95);
}

// Noise that neighbours share, as photons make it: each pixel has the mean of 5 x 5 independent values.
TEST_F(PredictionTest, noiseThatPixelsShareIsNoBias) {
  const Image without = scene();
  Pilot pilot{.parts = {}, .seconds = 1, .biased = true};
  for (unsigned part = 0; part < 4; ++part) {
    const Image alone = noisy(0.25, 0, part);
    Image& image = pilot.parts[part] = without;
    for (uint32_t i = 0; i < 3 * kSide * kSide; ++i) {
      const uint32_t x = i / 3 % kSide, y = i / 3 / kSide;
      for (uint32_t k = 0; k < 25; ++k) {
        const uint32_t from = 3 * ((y + k / 5) % kSide * kSide + (x + k % 5) % kSide) + i % 3;
        image.pixels[i] += (alone.pixels[from] - without.pixels[from]) / 25;
      }
    }
  }
  EXPECT_GT(predict(reference_, pilot, 0.95).ssimLimit, 0.999);
}

// What a pilot lacks of a method that samples everything is noise.
TEST_F(PredictionTest, aMethodWithoutBiasGetsThereWhateverItsPilotLacks) {
  Pilot pilot = pilotOf(4, -0.6);
  pilot.biased = false;
  const Prediction p = predict(reference_, pilot, 0.95);
  ASSERT_TRUE(p.seconds);
  EXPECT_GT(p.ssimLimit, 0.999);
}

// Noise of the reference looks like detail, which hides the noise of an image. The interval holds the time all the
// same.
TEST_F(PredictionTest, theIntervalHoldsTheTimeWhateverNoiseTheReferenceHas) {
  const double time = *predict(reference_, pilotOf(4, 0), 0.95).seconds;
  double before = 1;
  for (const double seconds : {64.0, 8.0, 2.0}) {
    Pilot noisyReference{.parts = {}, .seconds = seconds};
    for (unsigned part = 0; part < 4; ++part) noisyReference.parts[part] = noisy(seconds / 4, 0, 100 + part);
    const Prediction p = predict(PilotReference(noisyReference), pilotOf(4, 0), 0.95);
    ASSERT_TRUE(p.seconds) << seconds;
    EXPECT_LT(p.interval.low, time) << seconds;
    EXPECT_GT(p.interval.high, time) << seconds;
    EXPECT_GT(p.interval.high / p.interval.low, before) << seconds << ": less is known";
    before = p.interval.high / p.interval.low;
  }
}

TEST_F(PredictionTest, aBiasThatShrinksIsOvercomeInTime) {
  Pilot pilot = pilotOf(4, -0.6);
  pilot.biasExponent = biasDecay(0.75);
  EXPECT_DOUBLE_EQ(pilot.biasExponent, 0.25);
  const Prediction p = predict(reference_, pilot, 0.95);
  ASSERT_TRUE(p.seconds);
  EXPECT_GT(*p.seconds, *predict(reference_, pilotOf(4, 0), 0.95).seconds);
}

}  // namespace
}  // namespace wavecrest
