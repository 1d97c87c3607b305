// The noise of trial images, and the light that they have missed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/film/pixel_blocks.h"

namespace wavecrest {

// What is kept of one candidate's images, by tiles (PixelBlocks).
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
  PixelBlocks blocks_;
  uint64_t pairs_ = 0;                              // of iterations
  std::vector<size_t> pixels_;                      // of each tile
  std::vector<double> sums_, variances_, ofMeans_;  // weighted by iterations
};

struct TrialError {
  double variance = 0, missed = 0;  // as of MethodTrial
};

// The errors of all candidates, which estimate the same image. A method that rarely samples a bright path looks free of
// noise until it does. So if a tile is darker than another candidate's by more than two standard errors of each, the
// difference counts as missed: if n samples have not found a part f of the brightness, the variance of a sample is n
// f^2 or more. A candidate whose tile is black has missed all of it. Errors are relative to the tile's brightness, or
// to a quarter of the image's mean where a tile is darker than that. All images must have the same size and one pair or
// more.
std::vector<TrialError> trialErrors(std::span<const TrialImages> candidates);

}  // namespace wavecrest
