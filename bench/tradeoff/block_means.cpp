#include "bench/tradeoff/block_means.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/statistics/bands.h"
#include "engine/film/pixel_blocks.h"

namespace wavecrest {
namespace {

// A difference relative to the reference, with its probability by Student's test.
// Values that are equal to the bit have no variance and no bias.
Bias biasOf(const MeanEstimate& difference, double reference) {
  Bias bias;
  if (reference == 0) return bias;
  const double error = std::sqrt(difference.variance);
  bias.value = difference.mean / reference;
  bias.standardError = error / std::abs(reference);
  if (difference.mean == 0) return bias;
  const int degrees = std::max(static_cast<int>(difference.degreesOfFreedom), 1);
  // A difference without any variance cannot be chance.
  bias.probability = error == 0 ? 0 : studentTail(difference.mean / error, degrees);
  return bias;
}

// The means of one block in several images.
std::vector<double> ofBlock(std::span<const BlockMeans> images, size_t block) {
  std::vector<double> values;
  for (const BlockMeans& means : images) values.push_back(means[block]);
  return values;
}

// compare(i): the bias of block i, or of the image for the last.
template <class Compare>
BlockComparison overBlocks(size_t count, Compare&& compare) {
  BlockComparison result;
  result.mean = compare(count - 1);
  const size_t blocks = count - 1;
  // Blocks that are off by more than is negligible come first: where all images have the same last bit, as in a lamp,
  // rounding has the probability 0.
  const auto rank = [](const Bias& bias) {
    return std::pair(std::abs(bias.value) <= kNegligibleBias, bias.probability);
  };
  for (size_t i = 0; i < blocks; ++i) {
    const Bias bias = compare(i);
    if (i == 0 || rank(bias) < rank(result.worstBlock)) result.worstBlock = bias;
  }
  // One of so many probabilities, at least the smallest, is corrected for their number (Bonferroni).
  result.worstBlock.probability = std::min(1.0, static_cast<double>(blocks) * result.worstBlock.probability);
  return result;
}

}  // namespace

BlockMeans blockMeans(std::span<const float> film, uint32_t width) {
  const PixelBlocks blocks = PixelBlocks::of(film.size(), width);
  BlockMeans means(blocks.count() + 1, 0.0);
  // Blocks at the right and lower edges may have fewer samples.
  std::vector<double> samples(means.size(), 0.0);
  for (size_t i = 0; i < film.size(); ++i) {
    // Each sample counts for its block and for the whole image.
    for (const size_t block : {blocks.ofSample(i), blocks.count()}) {
      means[block] += film[i];
      ++samples[block];
    }
  }
  for (size_t i = 0; i < means.size(); ++i) means[i] /= samples[i];
  return means;
}

BlockComparison comparePaired(std::span<const BlockMeans> own, std::span<const BlockMeans> reference) {
  return overBlocks(own.front().size(), [&](size_t i) {
    const std::vector<double> base = ofBlock(reference, i);
    std::vector<double> differences = ofBlock(own, i);
    for (size_t seed = 0; seed < differences.size(); ++seed) differences[seed] -= base[seed];
    return biasOf(meanOf(differences), meanOf(base).mean);
  });
}

BlockComparison compareIndependent(std::span<const BlockMeans> own, std::span<const BlockMeans> reference) {
  return overBlocks(own.front().size(), [&](size_t i) {
    const std::vector<double> base = ofBlock(reference, i);
    return biasOf(differenceOf(ofBlock(own, i), base), meanOf(base).mean);
  });
}

}  // namespace wavecrest
