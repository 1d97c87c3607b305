// Vectors in double, for what is computed once: when a scene is loaded, compiled, or put into an intersector.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace wavecrest {

using D3 = std::array<double, 3>;

template <class Real>
D3 vec(const Real (&a)[3]) {
  return {a[0], a[1], a[2]};
}
inline D3 operator+(const D3& a, const D3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline D3 operator-(const D3& a, const D3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline D3 operator*(double s, const D3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline D3 operator*(const D3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const D3& a, const D3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline D3 cross(const D3& a, const D3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const D3& a) { return std::sqrt(dot(a, a)); }
inline D3 normalized(const D3& a) { return a * (1 / length(a)); }
// |a0 b0| + |a1 b1| + |a2 b2|: rounding of dot(a, b) is bounded by a few units of it.
inline double absDot(const D3& a, const D3& b) {
  return std::abs(a[0] * b[0]) + std::abs(a[1] * b[1]) + std::abs(a[2] * b[2]);
}

template <class Real>
void assign(Real (&out)[3], const D3& a) {
  for (size_t i = 0; i < 3; ++i) out[i] = static_cast<Real>(a[i]);
}

}  // namespace wavecrest
