// Correlation of planes with the pyramid's square kernels, shared by decomposition and reconstruction. Internal.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "metrics/planes/plane.h"

namespace wavecrest::vdp {

// Reflection about the edge sample, which is not repeated; index is less than length outside.
inline size_t mirroredIndex(std::ptrdiff_t index, size_t length) {
  const auto last = static_cast<std::ptrdiff_t>(length) - 1;
  if (index < 0) index = -index;
  if (index > last) index = 2 * last - index;
  return static_cast<size_t>(index);
}

// Fills the samples beside a row; border is less than the width.
inline void mirrorBorders(Plane& plane, size_t y, size_t border) {
  float* row = plane.row(y);
  const auto width = static_cast<std::ptrdiff_t>(plane.width());
  for (auto i = std::ptrdiff_t{1}; i <= static_cast<std::ptrdiff_t>(border); ++i) {
    row[-i] = row[mirroredIndex(-i, plane.width())];
    row[width - 1 + i] = row[mirroredIndex(width - 1 + i, plane.width())];
  }
}

// The pointers that make row y of a correlation with a kSize x kSize kernel: one for each tap.
template <size_t kSize>
std::array<const float*, kSize * kSize> tapRows(const Plane& in, size_t y) {
  constexpr auto kCentre = static_cast<std::ptrdiff_t>(kSize / 2);
  std::array<const float*, kSize * kSize> rows{};
  for (size_t i = 0; i < kSize; ++i) {
    const float* row = in.row(mirroredIndex(static_cast<std::ptrdiff_t>(y + i) - kCentre, in.height())) - kCentre;
    for (size_t j = 0; j < kSize; ++j) rows[i * kSize + j] = row + j;
  }
  return rows;
}

template <size_t kCount>
std::array<float, kCount> toFloat(const std::array<double, kCount>& taps) {
  std::array<float, kCount> result{};
  std::transform(taps.begin(), taps.end(), result.begin(), [](double t) { return static_cast<float>(t); });
  return result;
}

// A kernel for the adjoint of a correlation: turned by half a turn.
template <size_t kCount>
std::array<float, kCount> turned(const std::array<double, kCount>& taps) {
  auto result = toFloat(taps);
  std::reverse(result.begin(), result.end());
  return result;
}

template <class Function>
void forEachRow(size_t rows, Function function) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, rows, 4), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t y = range.begin(); y < range.end(); ++y) function(y);
  });
}

}  // namespace wavecrest::vdp
