// Discrete Fourier transforms of any length, 16 at a time in single precision.
//
// The images of a comparison need thousands of transforms of one length, so each SIMD lane carries its own transform
// and nothing is ever shuffled. At the sizes of the metrics this is several times faster than kissfft, which remains
// the oracle of the tests and the baseline of the microbenchmark. Lengths with a prime factor above 13 go through
// Bluestein's chirp convolution.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/kernels/fft_stage.h"

namespace wavecrest {

class FftPlan {
 public:
  explicit FftPlan(size_t length, Isa isa = bestIsa());

  size_t length() const { return length_; }

  // Floats of the work space that transform needs: two batches of the longest inner transform.
  size_t workFloats() const;

  // Transforms the batch that starts at `data` (length elements of kFftElement floats, 64-byte aligned) in place.
  // The inverse is not scaled: forward and inverse together multiply by the length.
  void transform(float* data, float* work, FftDirection direction) const;

 private:
  void makeStages();
  void makeChirp();
  // Runs all stages between two buffers and returns the one that holds the result.
  float* runStages(float* data, float* other, FftDirection direction) const;

  Isa isa_;
  size_t length_;
  std::vector<FftStage> stages_;
  // Bluestein: an inner transform of a convenient length, the chirp, and the transform of its conjugate.
  std::unique_ptr<FftPlan> inner_;
  std::vector<float> chirp_, chirpSpectrum_;
};

}  // namespace wavecrest
