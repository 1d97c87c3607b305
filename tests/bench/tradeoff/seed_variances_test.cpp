// Variances of made-up images, whose noise is known.
#include "bench/tradeoff/seed_variances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/statistics/bands.h"

namespace wavecrest {
namespace {

constexpr size_t kSide = 8, kSamples = 3 * kSide * 8;  // one block

// Values of seven images of mean 1, of which the third has a sample that is brighter by so much.
std::vector<double> valuesOf(std::mt19937_64& random, float sigma, float bright = 0) {
  const std::vector<float> reference(kSamples, 1.0f);
  std::normal_distribution<float> noise(1, sigma);
  SeedVariances variances;
  for (int seed = 0; seed < 7; ++seed) {
    std::vector<float> film(kSamples);
    for (float& value : film) value = noise(random);
    if (seed == 2) film.front() += bright;
    variances.add(film, reference, kSide);
  }
  return variances.values();
}

// The deviation of a value of 192 samples is a tenth of it.
TEST(SeedVariances, areThoseOfOneImage) {
  std::mt19937_64 random(1);
  for (const float sigma : {0.1f, 0.4f}) {
    const std::vector<double> values = valuesOf(random, sigma);
    ASSERT_EQ(values.size(), 6u);
    for (const double value : values) EXPECT_NEAR(std::sqrt(value) / static_cast<double>(sigma), 1, 0.25);
    EXPECT_NEAR(std::sqrt(meanOf(values).mean) / static_cast<double>(sigma), 1, 0.1);
  }
}

TEST(SeedVariances, haveAnOutlierOnce) {
  std::mt19937_64 random(2);
  std::vector<double> values = valuesOf(random, 1e-3f, 10);
  std::sort(values.begin(), values.end());
  EXPECT_NEAR(values.back(), 100.0 * 2 / 3 / kSamples, 1e-3);
  EXPECT_LT(values[4], 0.2 * values.back());
}

// Six independent ratios are all on one side of the truth in 1 of 32 cases: 387 +- 3.5 of 400 intervals hold it.
TEST(SeedVariances, ratiosHaveIntervalsThatHoldTheTruth) {
  std::mt19937_64 random(3);
  size_t holds = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::vector<double> base = valuesOf(random, 0.1f), own = valuesOf(random, 0.1f);
    const Interval interval = medianRatio(base, own).interval;
    holds += interval.low <= 1 && interval.high >= 1;
  }
  EXPECT_GE(holds, 372u);
  EXPECT_LT(holds, 400u) << "or they are too wide";
}

}  // namespace
}  // namespace wavecrest
