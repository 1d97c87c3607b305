#include "bench/campaign/reference_agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
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

// Sums over the blocks of a tile. variance: of the sum of differences, estimated from the half differences of both
// references.
struct Sums {
  double difference = 0, variance = 0, total = 0;
  int blocks = 0;

  void add(double a, double b, double halfA, double halfB) {
    difference += a - b;
    variance += halfA * halfA + halfB * halfB;
    total += 0.5 * (a + b);
    ++blocks;
  }
  double z() const {
    if (variance > 0) return std::abs(difference) / std::sqrt(variance);
    return difference == 0 ? 0 : HUGE_VAL;
  }
};

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
  return fmt::format("{}: means differ by {:.2g} %, largest z of {} tiles and the whole {:.2f}, limit {:.2f}",
                     agrees() ? "agree" : "disagree", 100 * relativeDifference, tiles, largestZ, limit);
}

Agreement compareReferences(const Reference& a, const Reference& b) {
  requireComparable(a, b);
  // Means of blocks, for both references and their half differences.
  const uint32_t columns = a.mean.width / kBlock, rows = a.mean.height / kBlock;
  const std::vector<double> meansA = blockMeans(a.mean, columns, rows), meansB = blockMeans(b.mean, columns, rows);
  const std::vector<double> halvesA = blockMeans(*a.difference, columns, rows),
                            halvesB = blockMeans(*b.difference, columns, rows);
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
  // limit holds for all.
  Agreement agreement{.tiles = kTilesX * kTilesY, .largestZ = whole.z()};
  int fewest = whole.blocks;
  for (const Sums& tile : tiles) {
    agreement.largestZ = std::max(agreement.largestZ, tile.z());
    fewest = std::min(fewest, tile.blocks);
  }
  agreement.limit = studentLimit(fewest, kFalseAlarms / (agreement.tiles + 1));
  agreement.relativeDifference = whole.total != 0 ? whole.difference / whole.total : 0;
  return agreement;
}

}  // namespace wavecrest
