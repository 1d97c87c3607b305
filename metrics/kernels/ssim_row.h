// One row of the structural similarity map. See metrics/ssim.h for the definition.
//
// With x the reference, y the test image and d = x - y, the two factors of SSIM are written so that the rounding of
// single precision cancels where the images agree:
//   luminance  (2 mx my + C1) / (mx^2 + my^2 + C1) = 1 - md^2 / (mx^2 + my^2 + C1)
//   structure  (2 cxy + C2) / (vx + vy + C2)       = 1 - vd / (vx + vy + C2)
// where m, v, c are window means, variances and covariance: md = mx - my and vd = vx + vy - 2 cxy.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

constexpr size_t kSsimTaps = 11;   // Gaussian window of sigma 1.5, cut at 5 pixels
constexpr float kSsimShift = 128;  // y is stored as code - 128: smaller squares, less rounding

struct SsimRow {
  std::array<const float*, kSsimTaps> difference;  // rows of d, top to bottom, `windows + 10` samples each
  std::array<const float*, kSsimTaps> test;        // rows of y - kSsimShift
  const float* referenceMean;                      // mx of each window
  const float* referenceVariance;                  // vx of each window
  const float* taps;                               // kSsimTaps weights that sum to 1
  size_t windows;                                  // windows in this row: width - 10
  float* scratch;                                  // three rows of roundUpToLanes(windows + 10) + 16 floats
  float* map;                                      // out: SSIM of each window, rounded up to whole vectors
};

}  // namespace wavecrest
