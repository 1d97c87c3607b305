// How far a film is from its expectation, from the render alone.
//
// in: the film after equal numbers of iterations. out: its relative error with an interval. Meant is the error that
// this very image has, not what images of so many iterations have on average: with rare bright samples the two differ a
// lot, and only the first can be known.
//
// The error of a pixel is taken relative to how bright the image is around it. Relative to the film's mean square, the
// edges of a lamp in view would decide alone; relative to the pixel itself, a dark pixel that has not met its light yet
// would.
//
// Of K slices x_k = mu + d_k the film is the mean. <a, b> is the weighted mean of a b over all samples. Then exactly
//
//   <mean d, mean d> = V + U,   V = sum_k |x_k - mean x|^2 / (K (K - 1)),   U = mean over j != k of <d_j, d_k>.
//
// V is known, and it contains every bright sample by as much as the error does. U has expectation 0, as slices are
// independent; its spread follows from contrasts <x_a - x_b, x_c - x_d> of four slices, which contain nothing else.
// Pixels may depend on each other within a slice: light paths that splat, photons that many pixels share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bench/statistics/medians.h"

namespace wavecrest {

struct FilmError {
  double value = 0;
  Interval interval;  // at kIntervalLevel
};

// Root of the mean over samples of ((film - expectation) / brightness)^2. brightness: the mean of the film's three
// channels over the pixel's block of 8 x 8, and kDarkest of the mean over the film at least. Images are RGB, row by
// row.
double relativeFilmError(std::span<const float> film, std::span<const float> expectation, size_t width);
constexpr double kDarkest = 0.01;
// 1 / brightness^2 of each sample of the film.
std::vector<float> errorWeights(std::span<const float> film, size_t width);

// Whether no sample is above 0: such a film has no relative error.
bool isBlack(std::span<const float> film);
// Iterations after which a film that is still black is not expected to find any light, nor one without variance any
// that is rare.
constexpr uint64_t kBlackIterations = 512;
// An error up to this is the rounding of equal slices: a film without variance, as of a constant sky.
constexpr double kNoVariance = 1e-6;

// slices: independent images of one size and of equal numbers of iterations; the film is their mean. Nothing where
// slices are fewer than kFewestSlices, black, or too uneven to tell, as with one sample that outshines the rest.
std::optional<FilmError> estimateFilmError(std::span<const std::vector<float>> slices, size_t width);
constexpr size_t kFewestSlices = 8;

// Cuts a growing film into equal slices, and joins them in pairs when they are 2 kFewestSlices.
class FilmSlices {
 public:
  // sliceIterations: of each slice at first.
  explicit FilmSlices(uint64_t sliceIterations = 1) : sliceIterations_(sliceIterations) {}
  // Iterations at which the film is to be added next.
  uint64_t nextIterations() const { return (slices_.size() + 1) * sliceIterations_; }
  // film: the mean of nextIterations() iterations.
  void add(std::vector<float> film);
  std::span<const std::vector<float>> slices() const { return slices_; }

 private:
  uint64_t sliceIterations_;
  std::vector<float> film_;  // as of the last add
  std::vector<std::vector<float>> slices_;
};

}  // namespace wavecrest
