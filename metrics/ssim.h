// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) on 8-bit gamma-corrected values, per colour channel.
//
// Conventions, those of scikit-image with Gaussian weights: codes 0..255, 11x11 Gaussian window of sigma 1.5,
// population variances, C1 = (0.01 * 255)^2, C2 = (0.03 * 255)^2, mean over the windows that lie wholly inside the
// image. The score is the mean of the three channels. A fourth score is of the luma, 0.2126 R + 0.7152 G + 0.0722 B
// rounded to 8 bits.
#pragma once

#include <array>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/image/image.h"
#include "metrics/ssim_layer.h"

namespace wavecrest {

constexpr uint32_t kSsimSmallestSide = 11;

struct SsimResult {
  double mean = 0;  // of the three channels
  std::array<double, 3> channels{};
  double luma = 0;
  std::vector<float>
      map;  // mean of the channels, width * height, borders repeat the nearest window; empty unless asked
};

// Everything that depends on the reference alone. Immutable, so one object serves any number of threads.
class PreparedSsim {
 public:
  // Throws std::invalid_argument when a side is below kSsimSmallestSide.
  explicit PreparedSsim(const Image8& reference, Isa isa = bestIsa());

  // The test image has the reference's size.
  SsimResult compare(const Image8& test, bool withMap = false) const;

 private:
  PreparedSsimLayer colour_, luma_;
};

}  // namespace wavecrest
