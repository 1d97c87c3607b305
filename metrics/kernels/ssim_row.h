// One row of the structural similarity map. See metrics/ssim.h for the definition.
//
// With x the reference, y the test image and d = x - y, the two factors of SSIM are
//   luminance  (2 mx my + C1) / (mx^2 + my^2 + C1) = 1 - md^2 / (mx^2 + my^2 + C1)
//   structure  (2 cxy + C2) / (vx + vy + C2)       = 1 - vd / (vx + vy + C2)
// where m, v, c are window means, variances and covariance: md = mx - my and vd = vx + vy - 2 cxy. So one product fewer
// is filtered, and identical images give exactly 1. Codes are whole numbers: their squares and the sums of two squares
// are exact in single precision, and only the weighted sums are kept in double.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

constexpr size_t kSsimTaps = 11;  // Gaussian window of sigma 1.5, cut at 5 pixels
constexpr size_t kSsimRadius = kSsimTaps / 2;

struct SsimRow {
  std::array<const float*, kSsimTaps> difference;  // rows of d, top to bottom, windows + 10 whole numbers each
  std::array<const float*, kSsimTaps> test;        // rows of y
  const double* referenceMean;                     // mx of each window
  const double* referenceVariance;                 // vx of each window
  std::array<double, kSsimRadius + 1> taps;        // weights of the centre and of the offsets 1..5; symmetric, sum 1
  size_t windows;                                  // windows in this row: width - 10
  double* scratch;                                 // three rows of roundUpToLanes(windows + 10) + 16 numbers
  float* map;                                      // out: SSIM of each window, rounded up to whole vectors
};

}  // namespace wavecrest
