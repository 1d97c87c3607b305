// An affine transform with its inverse, for placing a group's primitives.
#pragma once

#include "engine/scene/vector_math.h"

namespace wavecrest {

struct Affine {
  Double3 linear[3]{}, inverse[3]{};  // rows; the inverse of the linear part
  Double3 offset{};
  bool mirrors = false;

  Affine() = default;
  // m: with an inverse.
  explicit Affine(const Matrix4& m) {
    Double3 column[3];
    for (size_t j = 0; j < 3; ++j) column[j] = {m[0][j], m[1][j], m[2][j]};
    const double determinant = dot(cross(column[0], column[1]), column[2]);
    for (size_t i = 0; i < 3; ++i) {
      linear[i] = {m[i][0], m[i][1], m[i][2]};
      inverse[i] = cross(column[(i + 1) % 3], column[(i + 2) % 3]) * (1 / determinant);
      offset[i] = m[i][3];
    }
    mirrors = determinant < 0;
  }

  Double3 vector(const Double3& v) const { return {dot(linear[0], v), dot(linear[1], v), dot(linear[2], v)}; }
  Double3 point(const Double3& p) const { return vector(p) + offset; }
  // By the inverse transpose: normals stay on their side, whatever the handedness. Not of unit length.
  Double3 normal(const Double3& n) const { return inverse[0] * n[0] + inverse[1] * n[1] + inverse[2] * n[2]; }
  // Whether spheres stay spheres, to within float rounding of a file.
  bool isUniform() const {
    constexpr double kTolerance = 1e-4;
    const auto column = [this](size_t j) { return Double3{linear[0][j], linear[1][j], linear[2][j]}; };
    const double scale = length(column(0));
    for (size_t j = 0; j < 3; ++j) {
      const Double3 a = column(j), b = column((j + 1) % 3);
      if (std::abs(length(a) - scale) > kTolerance * scale) return false;
      if (std::abs(dot(a, b)) > kTolerance * length(a) * length(b)) return false;
    }
    return true;
  }
  double scale() const { return length(Double3{linear[0][0], linear[1][0], linear[2][0]}); }  // where it is uniform
};

}  // namespace wavecrest
