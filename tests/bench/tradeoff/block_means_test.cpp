// Biases are found where they are, and hardly ever where they are not.
#include "bench/tradeoff/block_means.h"

#include <gtest/gtest.h>

#include <random>

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 40, kHeight = 20;  // 5 x 3 blocks, the last row of half height

std::vector<float> noisyFilm(std::mt19937_64& random, double sigma) {
  std::normal_distribution<float> normal(1, static_cast<float>(sigma));
  std::vector<float> film(size_t{3} * kWidth * kHeight);
  for (float& value : film) value = normal(random);
  return film;
}

// Brightens a block of 8 x 8 pixels.
void brighten(std::vector<float>& film, size_t blockX, size_t blockY, float factor) {
  for (size_t y = 8 * blockY; y < 8 * blockY + 8; ++y) {
    for (size_t i = 3 * (y * kWidth + 8 * blockX); i < 3 * (y * kWidth + 8 * blockX + 8); ++i) film[i] *= factor;
  }
}

struct Films {
  std::vector<BlockMeans> own, reference;
};

Films films(uint64_t seed, float factor, bool paired) {
  std::mt19937_64 random(seed);
  Films all;
  for (int i = 0; i < 6; ++i) {
    std::vector<float> own = noisyFilm(random, 0.3);
    all.reference.push_back(blockMeans(paired ? own : noisyFilm(random, 0.3), kWidth));
    for (float& value : own) value *= 1 + (paired ? 1e-7f : 0.0f) * static_cast<float>(i % 2);  // rounding
    brighten(own, 3, 1, factor);
    all.own.push_back(blockMeans(own, kWidth));
  }
  return all;
}

TEST(BlockMeans, areThoseOfTheirPixelsAndTheImage) {
  std::vector<float> film(size_t{3} * kWidth * kHeight, 1.0f);
  brighten(film, 4, 0, 3);
  const BlockMeans means = blockMeans(film, kWidth);
  ASSERT_EQ(means.size(), 16u);
  for (size_t i = 0; i < 15; ++i) EXPECT_EQ(means[i], i == 4 ? 3 : 1) << i;
  EXPECT_DOUBLE_EQ(means.back(), 1 + 2 * 64.0 / (kWidth * kHeight));
}

TEST(BlockMeans, equalImagesHaveNoBias) {
  const Films all = films(1, 1, true);
  const BlockComparison same = comparePaired(all.reference, all.reference);
  EXPECT_EQ(same.mean.value, 0);
  EXPECT_EQ(same.mean.probability, 1);
  EXPECT_EQ(same.worstBlock.probability, 1);
}

TEST(BlockMeans, aBiasOfOneBlockIsFoundThere) {
  for (const bool paired : {false, true}) {
    Films all = films(2, 1.5f, paired);
    // A block without noise that is rounded the same way in every image, such as a lamp: as significant as can be, and
    // negligible.
    for (BlockMeans& means : all.own) means[0] = 1 + 1e-7;
    for (BlockMeans& means : all.reference) means[0] = 1;
    const BlockComparison found =
        paired ? comparePaired(all.own, all.reference) : compareIndependent(all.own, all.reference);
    EXPECT_NEAR(found.worstBlock.value, 0.5, 0.1) << paired;
    EXPECT_LT(found.worstBlock.probability, 1e-3) << paired;
    EXPECT_NEAR(found.mean.value, 0.5 * 64 / (kWidth * kHeight), 0.02) << paired;
  }
}

// A verdict at 1 % falls in 1 % of cases; of 400 trials 12 or more have a probability below 1e-3.
TEST(BlockMeans, noiseAloneIsRarelyCalledABias) {
  size_t means = 0, blocks = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    const Films all = films(100 + seed, 1, false);
    const BlockComparison found = compareIndependent(all.own, all.reference);
    means += found.mean.probability < 0.01;
    blocks += found.worstBlock.probability < 0.01;
  }
  EXPECT_LT(means, 12u);
  EXPECT_GT(means, 0u) << "or the test would never find anything";
  EXPECT_LT(blocks, 12u);
}

}  // namespace
}  // namespace wavecrest
