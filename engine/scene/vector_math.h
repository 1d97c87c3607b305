// Double-precision vectors and their transforms, for everything that prepares a scene.
#pragma once

#include "engine/scene/scene.h"
#include "kernels/double_vectors.h"

namespace wavecrest {

inline Double3 widened(const Float3& a) { return {a[0], a[1], a[2]}; }

// The linear part of a matrix applied to a vector, and the whole matrix applied to a point.
inline Double3 transformVector(const Matrix4& m, const Double3& v) {
  Double3 out{};
  for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}
inline Double3 transformPoint(const Matrix4& m, const Double3& p) {
  return transformVector(m, p) + Double3{m[0][3], m[1][3], m[2][3]};
}

inline double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

}  // namespace wavecrest
