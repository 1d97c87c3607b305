// The filters of the steerable pyramid, as correlation kernels.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest::steerable {

constexpr size_t kHighPassSize = 15, kFirstLowPassSize = 9, kLowPassSize = 17, kBandSize = 9;
constexpr size_t kOrientations = 4;

extern const std::array<double, kHighPassSize * kHighPassSize> kHighPass;  // residual of the finest scale; sums to 0
extern const std::array<double, kFirstLowPassSize * kFirstLowPassSize> kFirstLowPass;  // its complement; sums to 1
extern const std::array<double, kLowPassSize * kLowPassSize> kLowPass;  // before each subsampling; sums to 2
// Oriented, odd under a half turn: the first reacts to change along x, the third along y.
extern const std::array<std::array<double, kBandSize * kBandSize>, kOrientations> kBands;

}  // namespace wavecrest::steerable
