#include "engine/trials/trial_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace wavecrest {
namespace {

constexpr double kDarkest = 0.25;     // of the image's mean brightness: errors are relative to at least that
constexpr double kTrimmed = 1e-3;     // part of the pixels
constexpr double kConfidence = 2.0;   // standard errors
constexpr double kLeastError = 1e-3;  // of the mean brightness: the least standard error that weights take

struct Reference {
  std::vector<double> brightness;  // by tile
  double mean = 0;                 // of the image
};

// The largest lower bound of the tile's brightness, over all candidates but one.
double surelyThere(std::span<const TrialImages> candidates, size_t tile, const TrialImages* but) {
  double most = 0;
  for (const TrialImages& images : candidates) {
    if (&images == but) continue;
    most = std::max(most, images.mean(tile) - kConfidence * images.standardError(tile));
  }
  return most;
}

// The mean of all candidates, weighted by their standard errors, but at least surelyThere().
Reference referenceOf(std::span<const TrialImages> candidates) {
  Reference reference;
  double brightest = 0;
  for (const TrialImages& images : candidates) brightest = std::max(brightest, images.brightness());
  for (size_t tile = 0; tile < candidates.front().tiles(); ++tile) {
    double sum = 0, weights = 0;
    for (const TrialImages& images : candidates) {
      if (images.mean(tile) == 0) continue;  // it may yet find light there
      const double error = images.standardError(tile) + kLeastError * brightest;
      const double weight = error > 0 ? 1 / (error * error) : 1;
      sum += weight * images.mean(tile);
      weights += weight;
    }
    const double mean = weights > 0 ? sum / weights : 0;
    reference.brightness.push_back(std::max(mean, surelyThere(candidates, tile, nullptr)));
  }
  reference.mean = brightest;
  return reference;
}

TrialError errorOf(const TrialImages& images, std::span<const TrialImages> candidates, const Reference& reference) {
  TrialError error;
  double pixels = 0;
  for (size_t tile = 0; tile < images.tiles(); ++tile) {
    const auto count = static_cast<double>(images.pixels(tile));
    pixels += count;
    const double here = std::max(reference.brightness[tile], kDarkest * reference.mean);
    if (!(here > 0)) continue;
    const double most = images.mean(tile) + kConfidence * images.standardError(tile);
    const double missed =
        most == 0 ? reference.brightness[tile] : std::max(surelyThere(candidates, tile, &images) - most, 0.0);
    const double samples = count * static_cast<double>(images.iterations());
    error.variance += count * images.variance(tile) / (here * here);
    error.missed += count * samples * missed * missed / (here * here);
  }
  return {.variance = error.variance / pixels, .missed = error.missed / pixels};
}

}  // namespace

TrialImages::TrialImages(uint32_t width, uint32_t height)
    : blocks_{width, height},
      pixels_(blocks_.count(), 0),
      sums_(blocks_.count(), 0),
      variances_(blocks_.count(), 0),
      ofMeans_(blocks_.count(), 0) {
  for (size_t sample = 0; sample < blocks_.samples(); sample += 3) ++pixels_[blocks_.ofSample(sample)];
}

void TrialImages::add(std::span<const float> first, std::span<const float> second, uint64_t iterations) {
  assert(first.size() == blocks_.samples() && second.size() == first.size());
  std::vector<double> sums(tiles(), 0), differences(tiles(), 0), squares(tiles(), 0);
  std::vector<std::pair<double, size_t>> pixels;  // squared difference and tile
  for (size_t i = 0; i < blocks_.samples(); i += 3) {
    const size_t tile = blocks_.ofSample(i);
    const auto brightness = [&](std::span<const float> image) {
      return (double{image[i]} + double{image[i + 1]} + double{image[i + 2]}) / 3;
    };
    const double a = brightness(first), b = brightness(second);
    sums[tile] += a + b;
    differences[tile] += a - b;
    pixels.emplace_back((a - b) * (a - b), tile);
  }
  // The noisiest pixels are left out, as fireflies are of relMSE.
  const auto kept = pixels.end() - static_cast<ptrdiff_t>(kTrimmed * static_cast<double>(pixels.size()));
  std::nth_element(pixels.begin(), kept, pixels.end());
  for (auto pixel = pixels.begin(); pixel != kept; ++pixel) squares[pixel->second] += pixel->first;
  // Half the squared difference is the variance of either image; n times that is the variance of one iteration. The
  // mean over pairs is weighted by n once more: longer images have seen more of what is rare.
  const auto n = static_cast<double>(iterations);
  for (size_t tile = 0; tile < tiles(); ++tile) {
    const auto count = static_cast<double>(pixels_[tile]);
    sums_[tile] += n * sums[tile] / count;
    variances_[tile] += n * n * squares[tile] / (2 * count);
    ofMeans_[tile] += n * n * differences[tile] * differences[tile] / (2 * count * count);
  }
  pairs_ += iterations;
}

double TrialImages::brightness() const {
  double sum = 0;
  for (size_t tile = 0; tile < tiles(); ++tile) sum += mean(tile) * static_cast<double>(pixels_[tile]);
  return 3 * sum / static_cast<double>(blocks_.samples());
}

double TrialImages::standardError(size_t tile) const {
  const double independent = variance(tile) / static_cast<double>(pixels_[tile]);
  const double whole = ofMeans_[tile] / static_cast<double>(pairs_);
  return std::sqrt(std::max(independent, whole) / static_cast<double>(iterations()));
}

std::vector<TrialError> trialErrors(std::span<const TrialImages> candidates) {
  const Reference reference = referenceOf(candidates);
  std::vector<TrialError> errors;
  for (const TrialImages& images : candidates) errors.push_back(errorOf(images, candidates, reference));
  return errors;
}

}  // namespace wavecrest
