// References agree where their truths do, whatever their noise, and disagree where a small part of the image is off.
#include "bench/campaign/reference_agreement.h"

#include <gtest/gtest.h>

#include <random>

#include "bench/results/noise_floors.h"

namespace wavecrest {
namespace {

// Two halves of a grey image of this value, with noise of this deviation in each.
Reference noisy(unsigned seed, double deviation, float value = 0.5f, uint32_t width = 128, uint32_t height = 96) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, static_cast<float>(deviation));
  Image mean{.width = width, .height = height, .channels = 3, .pixels = std::vector<float>(3 * width * height)};
  Image difference = mean;
  for (size_t i = 0; i < mean.pixels.size(); ++i) {
    const float a = value + noise(random), b = value + noise(random);
    mean.pixels[i] = 0.5f * (a + b);
    difference.pixels[i] = 0.5f * (a - b);
  }
  return {.mean = mean, .difference = difference, .info = {}, .noiseFloors = {}};
}

// Forty comparisons of equal truths; a limit for one in a hundred lets four of forty pass with a probability of 1e-3 at
// most (binomial), so this fails by chance that often.
TEST(CompareReferences, equalTruthsAgree) {
  int disagreements = 0;
  for (unsigned i = 0; i < 40; ++i) {
    disagreements += compareReferences(noisy(2 * i, 0.1), noisy(2 * i + 1, 0.3)).agrees() ? 0 : 1;
  }
  EXPECT_LE(disagreements, 3);
}

TEST(CompareReferences, aCornerThatIsOffIsFound) {
  const Reference a = noisy(1, 0.1);
  Reference b = noisy(2, 0.1);
  for (uint32_t y = 0; y < 32; ++y) {
    for (uint32_t x = 0; x < 3 * 32; ++x) b.mean.pixels[y * 3 * 128 + x] += 0.02f;
  }
  const Agreement agreement = compareReferences(a, b);
  EXPECT_FALSE(agreement.agrees()) << agreement.describe();
  EXPECT_GT(agreement.largestZ, 5);
  EXPECT_LT(std::abs(agreement.relativeDifference), 0.01) << "little of the whole";
}

// Chains leave their samples in neighbouring blocks: here noise of patches of 16 pixels, in addition to that of pixels.
Reference correlated(unsigned seed) {
  Reference reference = noisy(seed, 0.1);
  std::mt19937 random(seed + 1000);
  std::normal_distribution<float> noise(0, 0.02f);
  for (uint32_t y = 0; y < 96; y += 16) {
    for (uint32_t x = 0; x < 128; x += 16) {
      const float a = noise(random), b = noise(random);
      for (uint32_t row = y; row < y + 16; ++row) {
        for (uint32_t i = 3 * x; i < 3 * (x + 16); ++i) {
          reference.mean.pixels[row * 3 * 128 + i] += 0.5f * (a + b);
          reference.difference->pixels[row * 3 * 128 + i] += 0.5f * (a - b);
        }
      }
    }
  }
  return reference;
}

TEST(CompareReferences, chainsShareTheirNoiseAmongBlocks) {
  int asOthers = 0, asChains = 0, missed = 0;
  for (unsigned i = 0; i < 40; ++i) {
    Reference chains = correlated(i);
    const Reference paths = noisy(2000 + i, 0.1);
    asOthers += compareReferences(chains, paths).agrees() ? 0 : 1;
    chains.info.method = "mlt";
    asChains += compareReferences(chains, paths).agrees() ? 0 : 1;
    for (uint32_t y = 0; y < 32; ++y) {
      for (uint32_t x = 0; x < 3 * 32; ++x) chains.mean.pixels[y * 3 * 128 + x] += 0.1f;
    }
    missed += compareReferences(paths, chains).agrees() ? 1 : 0;
  }
  EXPECT_GT(asOthers, 5) << "or the noise is not correlated enough to tell";
  EXPECT_LE(asChains, 3);
  EXPECT_EQ(missed, 0) << "a tile that is off by twenty per cent is found";
}

// Two halves whose brightness is off by 2 %, either up or down.
TEST(CompareReferences, theBrightnessOfChainsIsNotTested) {
  int disagreements = 0;
  for (unsigned i = 0; i < 40; ++i) {
    Reference chains = correlated(i);
    chains.info.method = "mlt";
    const float a = i % 2 == 0 ? 0.98f : 1.02f, b = i / 2 % 2 == 0 ? 0.98f : 1.02f;
    for (size_t k = 0; k < chains.mean.pixels.size(); ++k) {
      float &mean = chains.mean.pixels[k], &difference = chains.difference->pixels[k];
      const float halfA = a * (mean + difference), halfB = b * (mean - difference);
      mean = 0.5f * (halfA + halfB);
      difference = 0.5f * (halfA - halfB);
    }
    const Agreement agreement = compareReferences(chains, noisy(2000 + i, 0.1));
    disagreements += agreement.agrees() ? 0 : 1;
    EXPECT_NE(agreement.describe().find("which of mlt is not tested"), std::string::npos) << agreement.describe();
    if (i % 4 == 0) {
      EXPECT_NEAR(agreement.relativeDifference, -0.02, 0.015);
    }
  }
  EXPECT_LE(disagreements, 3);
}

TEST(CompareReferences, needsHalvesAndEqualSizes) {
  Reference plain = noisy(1, 0.1);
  plain.difference.reset();
  EXPECT_THROW(compareReferences(noisy(1, 0.1), plain), ReferenceComparisonError);
  EXPECT_THROW(compareReferences(noisy(1, 0.1), noisy(2, 0.1, 0.5f, 64, 96)), ReferenceComparisonError);
  EXPECT_THROW(compareReferences(noisy(1, 0.1, 0.5f, 32, 32), noisy(2, 0.1, 0.5f, 32, 32)), ReferenceComparisonError);
}

TEST(UnmetFloors, areNamedWithTheirBars) {
  EXPECT_TRUE(unmetFloors({{"ssim", 0.996}, {"relmse", 1e-5}}, 1e-3).empty());
  const std::vector<std::string> both = unmetFloors({{"ssim", 0.901}, {"relmse", 2e-4}}, 1e-3);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0], "SSIM of a perfect image is 0.901, below 0.995");
  EXPECT_EQ(both[1], "relMSE of a perfect image is 0.0002, above a tenth of the best run's 0.001");
  EXPECT_EQ(unmetFloors({{"relmse", 2e-4}}).size(), 0u) << "no run to compare with";
}

}  // namespace
}  // namespace wavecrest
