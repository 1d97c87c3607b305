// Multi-scale structural similarity (Wang, Simoncelli, Bovik, "Multiscale structural similarity for image quality
// assessment", 2003) on 8-bit gamma-corrected values: five scales, each half as large as the one before, product of the
// structure factors of four of them and of the whole SSIM of the coarsest, raised to 0.0448, 0.2856, 0.3001, 0.2363 and
// 0.1333.
//
// Windows are those of metrics/ssim.h. A scale is halved by 2x2 means; a last row or column without a partner is its
// own. Each colour channel has its own score, as with SSIM here; the score is their mean. A mean structure factor below
// zero counts as zero.
#pragma once

#include <array>
#include <vector>

#include "metrics/image/image.h"
#include "metrics/ssim_layer.h"

namespace wavecrest {

constexpr size_t kMsSsimScales = 5;
constexpr uint32_t kMsSsimSmallestSide = 161;  // from here on the coarsest scale has 11 pixels

struct MsSsimResult {
  double mean = 0;  // of the three channels
  std::array<double, 3> channels{};
  // The same product of the windows around each pixel, mean of the channels; width * height, empty unless asked for.
  std::vector<float> map;
};

// Everything that depends on the reference alone. Immutable, so one object serves any number of threads.
class PreparedMsSsim {
 public:
  // Throws std::invalid_argument when a side is below kMsSsimSmallestSide.
  explicit PreparedMsSsim(const Image8& reference, Isa isa = bestIsa());

  // The test image has the reference's size.
  MsSsimResult compare(const Image8& test, bool withMap = false) const;

 private:
  std::vector<PreparedSsimLayer> scales_;
};

}  // namespace wavecrest
