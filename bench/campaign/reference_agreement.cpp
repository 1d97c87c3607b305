#include "bench/campaign/reference_agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bench/statistics/bands.h"

namespace wavecrest {
namespace {

// The side of a block. Tiles in the width and the height of the image.
constexpr uint32_t kBlock = 8;  // pixels
constexpr uint32_t kTilesX = 4, kTilesY = 3;

// Probability of a false alarm where the truths agree. The tests of twelve tiles and of the whole image share it
// equally (Bonferroni).
constexpr double kFalseAlarms = 0.01;

// The value that the magnitude of Student's t exceeds with this probability, by bisection.
double studentLimit(int degreesOfFreedom, double probability) {
  double low = 0, high = 1e4;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (studentTail(middle, degreesOfFreedom) > probability ? low : high) = middle;
  }
  return high;
}

// The mean of each block over its pixels and channels. Samples that are not finite count as 0; what is left of the
// image at its right and bottom edge is ignored.
std::vector<double> blockMeans(const Image& image, uint32_t columns, uint32_t rows) {
  std::vector<double> means(size_t{columns} * rows);
  const uint32_t channels = image.channels;
  for (uint32_t y = 0; y < rows * kBlock; ++y) {
    for (uint32_t x = 0; x < columns * kBlock * channels; ++x) {
      const float sample = image.pixels[size_t{y} * image.width * channels + x];
      if (std::isfinite(sample)) means[size_t{y / kBlock} * columns + x / (kBlock * channels)] += sample;
    }
  }
  for (double& mean : means) mean /= kBlock * kBlock * channels;
  return means;
}

// Sums over the blocks of a tile of one reference's half differences, and the variance of that sum, and of the mean's,
// where blocks are independent.
struct Noise {
  double sum = 0, variance = 0;
  void add(double half) {
    sum += half;
    variance += half * half;
  }
};

// Sums over the blocks of a tile of both references.
struct Sums {
  double difference = 0;
  Noise a{}, b{};
  int blocks = 0;

  void add(double meanA, double meanB, double halfA, double halfB) {
    difference += meanA - meanB;
    a.add(halfA);
    b.add(halfB);
    ++blocks;
  }
  // Factors: by how much variances are larger than those of independent blocks.
  double z(double factorA, double factorB) const {
    const double variance = factorA * a.variance + factorB * b.variance;
    if (variance > 0) return std::abs(difference) / std::sqrt(variance);
    return difference == 0 ? 0 : HUGE_VAL;
  }
};

// Whether blocks share their noise: a Markov chain leaves samples in the blocks around it one after the other.
bool isCorrelated(const Reference& reference) { return reference.info.method == "mlt"; }

// Scales both halves of a reference to the same sum over blocks. means, halves: of blocks. Chains estimate the
// brightness of a half by one number, whose error all of its blocks share.
void scaleHalves(std::vector<double>& means, std::vector<double>& halves, double sum) {
  const double total = std::accumulate(means.begin(), means.end(), 0.0),
               difference = std::accumulate(halves.begin(), halves.end(), 0.0);
  if (!(total > std::abs(difference))) return;  // a half is black
  const double scaleA = sum / (total + difference), scaleB = sum / (total - difference);
  for (size_t i = 0; i < means.size(); ++i) {
    const double a = scaleA * (means[i] + halves[i]), b = scaleB * (means[i] - halves[i]);
    means[i] = 0.5 * (a + b);
    halves[i] = 0.5 * (a - b);
  }
}

// By how much the variance of a tile's sum is larger than that of independent blocks: the mean over tiles of what the
// halves' difference itself has, at least 1. noise: Sums::a or Sums::b.
double varianceFactor(const Reference& reference, const std::vector<Sums>& tiles, Noise Sums::*noise) {
  if (!isCorrelated(reference)) return 1;
  double sum = 0;
  for (const Sums& tile : tiles) {
    const Noise& own = tile.*noise;
    if (own.variance > 0) sum += own.sum * own.sum / own.variance;
  }
  return std::max(1.0, sum / static_cast<double>(tiles.size()));
}

void requireComparable(const Reference& a, const Reference& b) {
  if (!a.difference || !b.difference) {
    throw ReferenceComparisonError(
        "a reference without halves has no noise to compare by; expected those of "
        "`wavecrest reference`");
  }
  if (a.mean.width != b.mean.width || a.mean.height != b.mean.height) {
    throw ReferenceComparisonError(fmt::format("references of {}x{} and {}x{} pixels; expected equal sizes",
                                               a.mean.width, a.mean.height, b.mean.width, b.mean.height));
  }
  if (a.mean.width < 2 * kBlock * kTilesX || a.mean.height < 2 * kBlock * kTilesY) {
    throw ReferenceComparisonError(fmt::format("references of {}x{} pixels; expected {}x{} or more", a.mean.width,
                                               a.mean.height, 2 * kBlock * kTilesX, 2 * kBlock * kTilesY));
  }
}

}  // namespace

std::string Agreement::describe() const {
  return fmt::format("{}: means differ by {:.2g} %{}, largest z of {} tiles and the whole {:.2f}, limit {:.2f}",
                     agrees() ? "agree" : "disagree", 100 * relativeDifference,
                     testsBrightness ? "" : ", which of mlt is not tested", tiles, largestZ, limit);
}

Agreement compareReferences(const Reference& a, const Reference& b) {
  requireComparable(a, b);
  // Means of blocks, for both references and their half differences.
  const uint32_t columns = a.mean.width / kBlock, rows = a.mean.height / kBlock;
  std::vector<double> meansA = blockMeans(a.mean, columns, rows), meansB = blockMeans(b.mean, columns, rows);
  std::vector<double> halvesA = blockMeans(*a.difference, columns, rows),
                      halvesB = blockMeans(*b.difference, columns, rows);
  // Chains are compared but for the brightness of their halves.
  const double sumA = std::accumulate(meansA.begin(), meansA.end(), 0.0),
               sumB = std::accumulate(meansB.begin(), meansB.end(), 0.0);
  const bool correlated = isCorrelated(a) || isCorrelated(b);
  if (isCorrelated(a)) scaleHalves(meansA, halvesA, sumB);
  if (isCorrelated(b)) scaleHalves(meansB, halvesB, isCorrelated(a) ? sumB : sumA);
  // Sums them over tiles and over the whole image.
  std::vector<Sums> tiles(size_t{kTilesX} * kTilesY);
  Sums whole;
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x) {
      const size_t i = size_t{y} * columns + x;
      tiles[size_t{y * kTilesY / rows} * kTilesX + x * kTilesX / columns].add(meansA[i], meansB[i], halvesA[i],
                                                                              halvesB[i]);
      whole.add(meansA[i], meansB[i], halvesA[i], halvesB[i]);
    }
  }
  // The largest z, and the limit for it. The tile with the fewest blocks has the fewest degrees of freedom, so its
  // limit holds for all; of noise that blocks share only the tiles tell the variance, and their sum is fixed.
  const double factorA = varianceFactor(a, tiles, &Sums::a), factorB = varianceFactor(b, tiles, &Sums::b);
  Agreement agreement{
      .tiles = kTilesX * kTilesY, .testsBrightness = !correlated, .largestZ = whole.z(factorA, factorB)};
  int fewest = correlated ? static_cast<int>(tiles.size()) - 1 : whole.blocks;
  for (const Sums& tile : tiles) {
    agreement.largestZ = std::max(agreement.largestZ, tile.z(factorA, factorB));
    fewest = std::min(fewest, tile.blocks);
  }
  agreement.limit = studentLimit(fewest, kFalseAlarms / (agreement.tiles + 1));
  agreement.relativeDifference = sumA + sumB != 0 ? 2 * (sumA - sumB) / (sumA + sumB) : 0;
  return agreement;
}

}  // namespace wavecrest
