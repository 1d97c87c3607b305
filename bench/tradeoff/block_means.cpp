#include "bench/tradeoff/block_means.h"

#include <algorithm>
#include <cmath>

#include "bench/statistics/bands.h"

namespace wavecrest {
namespace {

constexpr size_t kBlock = 8;

struct Sample {
  double mean = 0, meanVariance = 0;
};

template <class Value>
Sample sampleOf(size_t count, Value&& value) {
  Sample sample;
  const auto n = static_cast<double>(count);
  for (size_t i = 0; i < count; ++i) sample.mean += value(i) / n;
  for (size_t i = 0; i < count; ++i) {
    sample.meanVariance += std::pow(value(i) - sample.mean, 2) / (n - 1) / n;
  }
  return sample;
}

// difference: of the means, with its variance. Values that are equal to the bit have no variance and no bias.
Bias biasOf(const Sample& difference, double reference, double degreesOfFreedom) {
  Bias bias;
  if (reference == 0) return bias;
  const double error = std::sqrt(difference.meanVariance);
  bias.value = difference.mean / reference;
  bias.standardError = error / std::abs(reference);
  if (difference.mean == 0) return bias;
  bias.probability =
      error == 0 ? 0 : studentTail(difference.mean / error, std::max(static_cast<int>(degreesOfFreedom), 1));
  return bias;
}

// compare(i): the bias of block i, or of the image for the last.
template <class Compare>
BlockComparison overBlocks(size_t count, Compare&& compare) {
  BlockComparison result;
  result.mean = compare(count - 1);
  const size_t blocks = count - 1;
  for (size_t i = 0; i < blocks; ++i) {
    const Bias bias = compare(i);
    if (i == 0 || bias.probability < result.worstBlock.probability) result.worstBlock = bias;
  }
  result.worstBlock.probability = std::min(1.0, static_cast<double>(blocks) * result.worstBlock.probability);
  return result;
}

}  // namespace

BlockMeans blockMeans(std::span<const float> film, uint32_t width) {
  const size_t height = film.size() / (size_t{3} * width), across = (width + kBlock - 1) / kBlock,
               down = (height + kBlock - 1) / kBlock;
  BlockMeans means(across * down + 1, 0.0);
  std::vector<double> samples(means.size(), 0.0);
  for (size_t y = 0; y < height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      const size_t block = y / kBlock * across + x / kBlock;
      for (size_t c = 0; c < 3; ++c) {
        const double value = film[3 * (y * width + x) + c];
        means[block] += value;
        means.back() += value;
      }
      samples[block] += 3;
      samples.back() += 3;
    }
  }
  for (size_t i = 0; i < means.size(); ++i) means[i] /= samples[i];
  return means;
}

BlockComparison comparePaired(std::span<const BlockMeans> own, std::span<const BlockMeans> reference) {
  return overBlocks(own.front().size(), [&](size_t i) {
    const Sample difference = sampleOf(own.size(), [&](size_t seed) { return own[seed][i] - reference[seed][i]; });
    const Sample base = sampleOf(reference.size(), [&](size_t seed) { return reference[seed][i]; });
    return biasOf(difference, base.mean, static_cast<double>(own.size()) - 1);
  });
}

BlockComparison compareIndependent(std::span<const BlockMeans> own, std::span<const BlockMeans> reference) {
  return overBlocks(own.front().size(), [&](size_t i) {
    const Sample a = sampleOf(own.size(), [&](size_t seed) { return own[seed][i]; });
    const Sample b = sampleOf(reference.size(), [&](size_t seed) { return reference[seed][i]; });
    const double variance = a.meanVariance + b.meanVariance;
    const double degrees = variance == 0
                               ? 1
                               : variance * variance /
                                     (a.meanVariance * a.meanVariance / static_cast<double>(own.size() - 1) +
                                      b.meanVariance * b.meanVariance / static_cast<double>(reference.size() - 1));
    return biasOf({a.mean - b.mean, variance}, b.mean, degrees);
  });
}

}  // namespace wavecrest
