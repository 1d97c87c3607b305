// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) on 8-bit gamma-corrected values, per colour channel.
//
// Conventions, those of scikit-image with Gaussian weights: codes 0..255, 11x11 Gaussian window of sigma 1.5,
// population variances, C1 = (0.01 * 255)^2, C2 = (0.03 * 255)^2, mean over the windows that lie wholly inside the
// image. The score is the mean of the three channels. A fourth score is of the luma 0.2126 R + 0.7152 G + 0.0722 B of
// the same codes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernels/simd/isa.h"
#include "metrics/image/image.h"
#include "metrics/plane.h"

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
  static constexpr size_t kPlanes = 4;  // R, G, B, luma
  struct Channel {
    Plane values;                // x, full size
    DoublePlane mean, variance;  // of each window: (width - 10) x (height - 10)
  };
  void compareRows(const Image8& test, size_t channel, size_t firstRow, std::span<double> rowSums, Plane* map) const;

  Isa isa_;
  std::array<double, 6> taps_{};  // centre and offsets 1..5 of the window
  std::array<Channel, kPlanes> channels_;
};

}  // namespace wavecrest
