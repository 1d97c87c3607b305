// Rough surfaces as mirrors in all directions: the GGX distribution of microfacet normals (Walter et al. 2007), Smith
// shadowing, and sampling of visible normals.
//
// Shadowing is separable, G = G1(fix) G1(gen), as in Mitsuba 3, against which images are compared; the
// height-correlated form would be up to some ten percent brighter at grazing angles on very rough surfaces.
//
// Everything is arranged around S(v) = |v_z| + sqrt(v_z^2 + alpha^2 (v_x^2 + v_y^2)), with G1(v) = 2 |v_z| / S(v): the
// cosine in the denominator of the density of visible normals and of f then cancels, and grazing directions need no
// care.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"

WAVECREST_SIMD_BEGIN

// Directions whose half vector is shorter than this are opposite: no microfacet joins them.
inline constexpr double kSmallestHalfVector2 = 1e-12;

template <class Real>
struct Ggx {
  Real alpha, alpha2;

  static WAVECREST_INLINE Ggx fromAlpha(Real alpha) {
    const Real a = max(alpha, Real(kSmallestAlpha));  // a texture may go below
    return {a, a * a};
  }

  // S(v) of the head comment; v is a unit vector on either side.
  WAVECREST_INLINE Real masking(Vec3<Real> v) const {
    const Real tangential2 = mulAdd(v.x, v.x, v.y * v.y);
    return abs(v.z) + sqrt(mulAdd(v.z, v.z, alpha2 * tangential2));
  }
};

// D of the normal along h, with |h|^2 = h2; h need not be a unit vector. The form with sin^2 keeps its digits for small
// alpha.
template <class P>
WAVECREST_INLINE typename P::Real ggxDensity(Ggx<typename P::Real> ggx, Vec3<typename P::Real> h, typename P::Real h2) {
  using Real = typename P::Real;
  const Real tangential2 = mulAdd(h.x, h.x, h.y * h.y);
  const Real ratio = h2 * reciprocal<P>(mulAdd(ggx.alpha2, h.z * h.z, tangential2));
  return ggx.alpha2 * Real(kInvPi) * ratio * ratio;
}

// A normal with density G1(v) max(0, v.m) D(m) / v_z, for v_z > 0. Dupuy and Benyoub, "Sampling Visible GGX Normals
// with Spherical Caps", 2023: mirroring a uniform direction of the cap z > -v_z about v, after stretching.
template <class P>
WAVECREST_INLINE Vec3<typename P::Real> sampleVisibleNormal(Ggx<typename P::Real> ggx, Vec3<typename P::Real> v,
                                                            typename P::Real u1, typename P::Real u2) {
  using Real = typename P::Real;
  const Vec3<Real> stretched = normalizeFast<P>(Vec3<Real>{v.x * ggx.alpha, v.y * ggx.alpha, v.z});
  const SinCos<Real> azimuth = sinCos2Pi(u2);
  const Real depth = u1 * (Real(1) + stretched.z);  // 1 - z of the direction in the cap
  const Real radius = sqrt(max(depth * (Real(2) - depth), Real(0)));
  const Real x = mulAdd(radius, azimuth.cos, stretched.x);
  const Real y = mulAdd(radius, azimuth.sin, stretched.y);
  const Real z = (Real(1) - u1) * (Real(1) + stretched.z);
  return normalizeFast<P>(Vec3<Real>{x * ggx.alpha, y * ggx.alpha, z});
}

// 2 (v.m) m - v
template <class Real>
WAVECREST_INLINE Vec3<Real> mirror(Vec3<Real> v, Vec3<Real> m, Real cosine) {
  return mulAdd(m, Real(2) * cosine, -v);
}

WAVECREST_SIMD_END
