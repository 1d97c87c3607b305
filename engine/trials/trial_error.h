// How noisy the images of trials are, and what they have missed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace wavecrest {

// What is kept of one candidate's images, by tiles of kTrialTile x kTrialTile pixels.
constexpr uint32_t kTrialTile = 8;
class TrialImages {
 public:
  TrialImages(uint32_t width, uint32_t height);

  // Two independent images of so many iterations each: RGB, row by row.
  void add(std::span<const float> first, std::span<const float> second, uint64_t iterations);

  uint64_t iterations() const { return 2 * pairs_; }
  size_t tiles() const { return sums_.size(); }
  size_t pixels(size_t tile) const { return pixels_[tile]; }
  // Brightness of a tile, (R + G + B) / 3.
  double mean(size_t tile) const { return sums_[tile] / static_cast<double>(iterations()); }
  double brightness() const;  // of the whole image
  // Of one iteration: the variance of a pixel's brightness, mean over the tile, without the noisiest 0.1 % of all
  // pixels. 0 before images were added.
  double variance(size_t tile) const { return variances_[tile] / static_cast<double>(pairs_); }
  // The standard error of mean(): from the pixels, as if they were independent, or from the tile where that is more.
  double standardError(size_t tile) const;

 private:
  uint32_t width_, height_, across_;
  uint64_t pairs_ = 0;                              // of iterations
  std::vector<size_t> pixels_;                      // of each tile
  std::vector<double> sums_, variances_, ofMeans_;  // weighted by iterations
};

struct TrialError {
  double variance = 0, missed = 0;  // as of MethodTrial
};

// What each candidate's images say of it beside the others'. All estimate the same image. One that seldom finds light
// which matters looks free of noise until it has. So what a tile lacks, beyond both standard errors, of another
// candidate's light counts as if that light came as rarely as its absence allows: a part f of the brightness that n
// samples have missed has a variance of n f^2 at least. A candidate that has found nothing in a tile has missed what
// the others have there in the mean. Errors are relative to the tile's brightness, in tiles that are much darker than
// the image to a part of its mean. All images must have the same size, and at least one pair.
std::vector<TrialError> trialErrors(std::span<const TrialImages> candidates);

}  // namespace wavecrest
