#include "bench/campaign/bias.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace wavecrest {

ErrorParts errorParts(std::span<const Image> images, const Reference& reference) {
  if (images.size() < 2) throw std::invalid_argument("errorParts: fewer than two images");
  // The halves, or twice the reference where it has none.
  const Image a = reference.difference ? reference.halfA() : reference.mean;
  const Image b = reference.difference ? reference.halfB() : reference.mean;
  const auto count = static_cast<double>(images.size());
  double same = 0, across = 0;  // sums over samples of the mean over equal and over different seeds
  size_t samples = 0;
  // A sample that is not finite in some image or half is left out.
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    // Per sample: products of errors, each against another half. The diagonal joins errors of one seed.
    double sumA = 0, sumB = 0, diagonal = 0;
    for (const Image& image : images) {
      const double errorA = double{image.pixels.at(i)} - a.pixels[i], errorB = double{image.pixels[i]} - b.pixels[i];
      sumA += errorA;
      sumB += errorB;
      diagonal += errorA * errorB;
    }
    // The mean over pairs of different seeds: all pairs are sumA sumB, without the diagonal.
    const double offDiagonal = (sumA * sumB - diagonal) / (count * (count - 1));
    if (!std::isfinite(offDiagonal) || !std::isfinite(diagonal)) continue;
    same += diagonal / count;
    across += offDiagonal;
    ++samples;
  }
  // E[same] = bias^2 + variance and E[across] = bias^2, as different seeds share no noise.
  const double n = static_cast<double>(samples);
  return {.meanSquareError = same / n, .variance = (same - across) / n, .biasSquared = across / n};
}

std::optional<double> unbiasedMse(const Image& image, const Reference& reference) {
  if (!reference.difference) return std::nullopt;
  const Image &mean = reference.mean, &difference = *reference.difference;
  double sum = 0, samples = 0;
  for (size_t i = 0; i < mean.pixels.size(); ++i) {
    // (T - A)(T - B) with A = M + D and B = M - D, so that (T - M)^2 - D^2 is left.
    const double error = double{image.pixels.at(i)} - mean.pixels[i], half = difference.pixels[i];
    const double product = error * error - half * half;
    if (!std::isfinite(product)) continue;
    sum += product;
    ++samples;
  }
  return sum / samples;
}

std::vector<BiasRecord> measureBiases(std::span<const RunRecord* const> runs, const Reference& reference) {
  std::vector<BiasRecord> biases;
  if (runs.size() < 2) return biases;
  for (const SnapshotRecord& first : runs[0]->snapshots) {
    // The images of this number. Runs begin and end with different ones, and some images are not there.
    std::vector<Image> images;
    for (const RunRecord* run : runs) {
      const auto own = std::ranges::find(run->snapshots, first.number, &SnapshotRecord::number);
      if (own == run->snapshots.end() || !std::filesystem::is_regular_file(own->file)) break;
      images.push_back(readImage(own->file).image);
    }
    if (images.size() < runs.size()) continue;
    const ErrorParts parts = errorParts(images, reference);
    biases.push_back({.scene = runs[0]->scene,
                      .method = runs[0]->method,
                      .number = first.number,
                      .seeds = static_cast<unsigned>(runs.size()),
                      .meanSquareError = parts.meanSquareError,
                      .variance = parts.variance,
                      .biasSquared = parts.biasSquared});
  }
  return biases;
}

}  // namespace wavecrest
