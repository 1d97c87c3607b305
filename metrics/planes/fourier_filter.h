// Filtering planes in the Fourier domain with a real gain, as HDR-VDP-2 defines it.
//
// A plane of w x h is put into the top-left quarter of a torus of 2w x 2h that is filled with a constant, transformed,
// multiplied by a gain that depends on the frequency's magnitude, transformed back, and cut to w x h again.
// What makes this fast: the constant is subtracted first, so three quarters are zero and half of all row transforms
// vanish; two real rows share one complex transform; each block of 16 spectrum columns goes forward, through the gain
// and back while it is in cache; columns are SIMD lanes (metrics/planes/fft.h).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/planes/fft.h"
#include "metrics/planes/plane.h"

namespace wavecrest {

// Samples of a gain on the torus' frequency grid, in the order in which the filter needs them.
struct FourierGain {
  AlignedArray<float> samples;
  double atZero = 0;
};

// One plane to filter. in and out may be the same plane.
struct FourierFilterJob {
  const Plane* in;
  Plane* out;
  double pad;  // the constant around the plane
};

class FourierFilter {
 public:
  FourierFilter(size_t width, size_t height, Isa isa = bestIsa());

  // gain(rho), rho in cycles per degree when the plane has samplesPerDegree samples per degree.
  FourierGain sampleGain(double samplesPerDegree, const std::function<double(double)>& gain) const;

  // Memory for one call of apply; may be reused by later calls.
  using Spectra = std::vector<AlignedArray<float>>;
  Spectra makeSpectra(size_t jobs) const;

  // All jobs in parallel, with the same gain.
  void apply(const FourierGain& gain, std::span<const FourierFilterJob> jobs, Spectra& spectra) const;

 private:
  void transformRows(const FourierFilterJob& job, size_t batch, float* spectrum) const;
  void filterColumns(const FourierGain& gain, size_t group, float* spectrum) const;
  void restoreRows(const FourierFilterJob& job, double constant, size_t batch, const float* spectrum) const;

  Isa isa_;
  size_t width_, height_;
  FftPlan rows_, columns_;  // lengths 2w and 2h
};

}  // namespace wavecrest
