// Three-vectors and RGB triples of lanes, for Real = Float or Double.
#pragma once

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct Vec3 {
  Real x, y, z;
};

template <class Real>
WAVECREST_INLINE Vec3<Real> operator+(Vec3<Real> a, Vec3<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> operator-(Vec3<Real> a, Vec3<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> operator-(Vec3<Real> a) {
  return {-a.x, -a.y, -a.z};
}
// Componentwise: throughput times reflectance.
template <class Real>
WAVECREST_INLINE Vec3<Real> operator*(Vec3<Real> a, Vec3<Real> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> operator*(Vec3<Real> a, Real s) {
  return {a.x * s, a.y * s, a.z * s};
}
// a * s + b
template <class Real>
WAVECREST_INLINE Vec3<Real> mulAdd(Vec3<Real> a, Real s, Vec3<Real> b) {
  return {mulAdd(a.x, s, b.x), mulAdd(a.y, s, b.y), mulAdd(a.z, s, b.z)};
}
template <class Real>
WAVECREST_INLINE Real dot(Vec3<Real> a, Vec3<Real> b) {
  return mulAdd(a.x, b.x, mulAdd(a.y, b.y, a.z * b.z));
}
template <class Real>
WAVECREST_INLINE Vec3<Real> cross(Vec3<Real> a, Vec3<Real> b) {
  return {mulSub(a.y, b.z, a.z * b.y), mulSub(a.z, b.x, a.x * b.z), mulSub(a.x, b.y, a.y * b.x)};
}
template <class Real>
WAVECREST_INLINE Real length2(Vec3<Real> a) {
  return dot(a, a);
}
template <class Real>
WAVECREST_INLINE Vec3<Real> normalize(Vec3<Real> a) {
  return a * (Real(1) / sqrt(length2(a)));
}
template <class Real, class MaskOf>
WAVECREST_INLINE Vec3<Real> select(MaskOf m, Vec3<Real> yes, Vec3<Real> no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> zeroUnless(Mask m, Vec3<Real> a) {
  return {zeroUnless(m, a.x), zeroUnless(m, a.y), zeroUnless(m, a.z)};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> abs(Vec3<Real> a) {
  return {abs(a.x), abs(a.y), abs(a.z)};
}
template <class Real>
WAVECREST_INLINE Real maxComponent(Vec3<Real> a) {
  return max(a.x, max(a.y, a.z));
}
template <class Real, class From>
WAVECREST_INLINE Vec3<Real> to(Vec3<From> a) {
  return {to<Real>(a.x), to<Real>(a.y), to<Real>(a.z)};
}

// An orthonormal frame around a unit normal. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017:
// branchless and without a singularity at n.z = -1.
template <class Real>
struct Frame {
  Vec3<Real> s, t, n;
  static WAVECREST_INLINE Frame fromNormal(Vec3<Real> n) {
    const Real sign = copySign(Real(1), n.z);
    const Real a = Real(-1) / (sign + n.z);
    const Real b = n.x * n.y * a;
    return {{mulAdd(sign * n.x * n.x, a, Real(1)), sign * b, -sign * n.x}, {b, mulAdd(n.y * n.y, a, sign), -n.y}, n};
  }
  WAVECREST_INLINE Vec3<Real> toWorld(Vec3<Real> v) const { return mulAdd(s, v.x, mulAdd(t, v.y, n * v.z)); }
  WAVECREST_INLINE Vec3<Real> toLocal(Vec3<Real> v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
};

WAVECREST_SIMD_END
