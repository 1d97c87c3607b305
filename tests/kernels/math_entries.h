// Entry points of math_entries.cpp: each function of kernels/simd/math.h on a column.
#pragma once

#include <cstddef>
#include <span>

namespace wavecrest {

// out[i] = function(a[i], b[i]) for i < count, a multiple of the lane count.
template <class T>
struct MathFunction {
  const char* name;
  void (*run)(const T* a, const T* b, T* out, size_t count);
};

struct MathEntries {
  size_t lanes;
  std::span<const MathFunction<float>> floats;
  std::span<const MathFunction<double>> doubles;
};

}  // namespace wavecrest
