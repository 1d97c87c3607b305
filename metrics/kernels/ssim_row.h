// One row of the structural similarity map. See metrics/ssim.h for the definition.
//
// With x the reference, y the test image and d = x - y, the two factors of SSIM are
//   luminance  (2 mx my + C1) / (mx^2 + my^2 + C1) = 1 - md^2 / (mx^2 + my^2 + C1)
//   structure  (2 cxy + C2) / (vx + vy + C2)       = 1 - vd / (vx + vy + C2)
// where m, v, c are window means, variances and covariance: md = mx - my and vd = vx + vy - 2 cxy. So one product fewer
// is filtered, and identical images give exactly 1.
//
// Rows keep the interleaved order of the image: down the columns that makes no difference, and across them the window
// steps over `channels` samples. Single precision is enough because each block of a row is filtered relative to the
// codes at its middle: variances of flat areas come from small numbers, whose squares are exact.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

constexpr size_t kSsimTaps = 11;  // Gaussian window of sigma 1.5, cut at 5 pixels
constexpr size_t kSsimRadius = kSsimTaps / 2;
constexpr size_t kSsimBlock = 96;   // windows of one block, all channels together
constexpr size_t kSsimSlack = 128;  // samples that the kernel may read and write beyond the end of a row

using SsimSums = std::array<double, 3>;  // of the map, per channel

// C1 and C2 of Wang et al. 2004, (0.01 L)^2 and (0.03 L)^2 for samples of the range 0..L.
struct SsimConstants {
  float luminance, structure;
};
constexpr SsimConstants ssimConstants(double range) {
  return {static_cast<float>(0.01 * range * 0.01 * range), static_cast<float>(0.03 * range * 0.03 * range)};
}
// With this C1 the luminance factor is 1, to the last digit, and the map is that of the structure factor alone.
constexpr float kSsimStructureOnly = 1e20f;

struct SsimRow {
  std::array<const float*, kSsimTaps> difference;  // rows of d, top to bottom
  std::array<const float*, kSsimTaps> test;        // rows of y
  const float* referenceMean;                      // mx of each window
  const float* referenceVariance;                  // vx of each window
  std::array<float, kSsimRadius + 1> taps;         // weights of the centre and of the offsets 1..5
  SsimConstants constants;
  size_t windows;   // of all channels: (width - 10) * channels
  size_t channels;  // 1 or 3
  float* map;       // out: SSIM of each window
};

}  // namespace wavecrest
