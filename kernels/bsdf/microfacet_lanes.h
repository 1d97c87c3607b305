// Rough surfaces as mirrors in all directions: distributions of microfacet normals, Smith shadowing and sampling of
// visible normals (Walter et al. 2007; Heitz and d'Eon 2014).
//
// Shadowing is separable, G = G1(wi) G1(wo), as in Mitsuba 3, against which images are compared; the
// height-correlated form would be up to some ten percent brighter at grazing angles on very rough surfaces.
//
// Everything is arranged around S(v) = 2 |v_z| / G1(v). The cosines in the denominators of f and of the density of
// visible normals then cancel, and grazing directions need no care:
//   density of visible normals  G1(v) max(0, v.m) D(m) / |v_z|  =  2 D(m) (v.m) / S(v)
//   D G / (4 |wi_z| |wo_z|)                                   =  D / (S(wi) S(wo))
//
// A distribution is a template over the precision policy with
//   static of(input) of a BsdfInput, masking(v) = S(v), density(h, h2) = D, sampleVisible(v, u1, u2),
// and, where G1 of f is an approximation, densityFactor(v) = exact G1 / G1 and weightFactor(v), its inverse.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"

WAVECREST_SIMD_BEGIN

// Directions whose half vector is shorter than this are opposite: no microfacet joins them.
inline constexpr double kSmallestHalfVector2 = 1e-12;

// GGX, D(m) = alpha^2 / (pi (alpha^2 m_z^2 + m_x^2 + m_y^2)^2): the sin^2 form keeps its digits for small alpha.
template <class P>
struct GgxNormals {
  using Real = typename P::Real;
  Real alpha, alpha2;

  static WAVECREST_INLINE GgxNormals fromAlpha(Real alpha) {
    const Real a = max(alpha, Real(kSmallestAlpha));  // a texture may go below
    return {a, a * a};
  }
  template <bool kTextured>
  static WAVECREST_INLINE GgxNormals of(const BsdfInput<P, kTextured>& input) {
    return fromAlpha(input.alpha());
  }

  // |v_z| + sqrt(v_z^2 + alpha^2 (v_x^2 + v_y^2)); v is a unit vector on either side.
  WAVECREST_INLINE Real masking(Vec3<Real> v) const {
    const Real tangential2 = mulAdd(v.x, v.x, v.y * v.y);
    return abs(v.z) + sqrt(mulAdd(v.z, v.z, alpha2 * tangential2));
  }

  WAVECREST_INLINE Real densityFactor(Vec3<Real>) const { return Real(1); }
  WAVECREST_INLINE Real weightFactor(Vec3<Real>) const { return Real(1); }

  // D of the normal along h, which need not be a unit vector; h2 = |h|^2.
  WAVECREST_INLINE Real density(Vec3<Real> h, Real h2) const {
    const Real tangential2 = mulAdd(h.x, h.x, h.y * h.y);
    const Real ratio = h2 * reciprocal(mulAdd(alpha2, h.z * h.z, tangential2));
    return alpha2 * Real(kInvPi) * ratio * ratio;
  }

  // A normal visible from v, or from its image above the surface. Dupuy and Benyoub, "Sampling Visible GGX Normals with
  // Spherical Caps", 2023: the half vector of v and a uniform direction of the cap z > -v_z, after stretching v to
  // alpha = 1.
  WAVECREST_INLINE Vec3<Real> sampleVisible(Vec3<Real> v, Real u1, Real u2) const {
    const Vec3<Real> stretched = normalize(Vec3<Real>{v.x * alpha, v.y * alpha, abs(v.z)});
    const SinCos<Real> azimuth = sinCos2Pi(u2);
    const Real depth = u1 * (Real(1) + stretched.z);  // 1 - z of the direction in the cap
    const Real radius = sqrt(max(depth * (Real(2) - depth), Real(0)));
    const Real x = mulAdd(radius, azimuth.cos, stretched.x);
    const Real y = mulAdd(radius, azimuth.sin, stretched.y);
    const Real z = (Real(1) - u1) * (Real(1) + stretched.z);
    return normalize(Vec3<Real>{x * alpha, y * alpha, z});
  }
};

// Mirror image of v about m: 2 (v.m) m - v.
template <class Real>
WAVECREST_INLINE Vec3<Real> mirror(Vec3<Real> v, Vec3<Real> m, Real cosine) {
  return mulAdd(m, Real(2) * cosine, -v);
}

WAVECREST_SIMD_END
