// What the two principled BSDFs share: Schlick's Fresnel factors, tints, roughness, and the diffuse lobes (Burley,
// "Physically Based Shading at Disney", 2012, and "Extending the Disney BRDF to a BSDF", 2015), with the constants of
// Mitsuba 3.
#pragma once

#include "kernels/bsdf/bsdf_anisotropic.h"
#include "kernels/bsdf/fresnel_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
WAVECREST_INLINE Real mix(Real a, Real b, Real share) {
  return mulAdd(b - a, share, a);
}
template <class Real>
WAVECREST_INLINE Vec3<Real> grey(Real a) {
  return {a, a, a};
}

// (1 - cosine)^5
template <class Real>
WAVECREST_INLINE Real schlickWeight(Real cosine) {
  const Real m = min(max(Real(1) - cosine, Real(0)), Real(1));
  const Real m2 = m * m;
  return m2 * m2 * m;
}
// The share of white in F0 + (1 - F0) weight, at |cos theta_i| from the side whose opposite has the relative index eta:
// the cosine is that of the side with the lower index.
template <class Real>
WAVECREST_INLINE Real schlickShare(Real cosine, Real eta) {
  const Real one(1);
  const Real sin2 = (one - cosine) * (one + cosine) / (eta * eta);
  return schlickWeight(select(eta > one, cosine, sqrt(max(one - sin2, Real(0)))));
}
template <class Real>
WAVECREST_INLINE Real normalReflectance(Real eta) {
  const Real ratio = (eta - Real(1)) / (eta + Real(1));
  return ratio * ratio;
}

// A colour of luminance 1; white for black.
template <class Real>
WAVECREST_INLINE Vec3<Real> tintOf(Vec3<Real> colour) {
  const Real luminance =
      mulAdd(colour.x, Real(0.212671f), mulAdd(colour.y, Real(0.715160f), colour.z * Real(0.072169f)));
  const Mask bright = luminance > Real(0);
  return select(bright, colour * (Real(1) / select(bright, luminance, Real(1))), grey(Real(1)));
}

// GGX of a perceptual roughness and an anisotropy in [0, 1], for directions with x along dp/du.
template <class P>
WAVECREST_INLINE StretchedGgx<P> principledNormals(typename P::Real roughness, typename P::Real anisotropic) {
  using Real = typename P::Real;
  const Real alpha = roughness * roughness, aspect = sqrt(Real(1) - Real(0.9f) * anisotropic);
  return StretchedGgx<P>::fromAlphas(alpha / aspect, alpha * aspect);
}

// The diffuse lobe, its retro-reflection at grazing angles, and the flattened one in the place of both, all over
// albedo / pi; `half` is the cosine between a direction and the half vector.
template <class Real>
WAVECREST_INLINE Real principledDiffuse(Real roughness, Real flatness, Real cosWi, Real cosWo, Real half) {
  const Real one(1), a = schlickWeight(cosWi), b = schlickWeight(cosWo);
  const Real retro = Real(2) * roughness * half * half;
  const Real diffuse = (one - Real(0.5f) * a) * (one - Real(0.5f) * b) + retro * (a + b + a * b * (retro - one));
  const Real grazing = Real(0.5f) * retro;
  const Real scattered = mix(one, grazing, a) * mix(one, grazing, b);
  const Real flat = Real(1.25f) * mulAdd(scattered, one / max(cosWi + cosWo, Real(1e-12f)) - Real(0.5f), Real(0.5f));
  return mix(diffuse, flat, flatness);
}

// The sheen lobe, at the same cosine.
template <class Real>
WAVECREST_INLINE Vec3<Real> principledSheen(Real sheen, Real sheenTint, Vec3<Real> tint, Real half) {
  const Real one(1), amount = sheen * schlickWeight(half);
  return {amount * mix(one, tint.x, sheenTint), amount * mix(one, tint.y, sheenTint),
          amount * mix(one, tint.z, sheenTint)};
}

WAVECREST_SIMD_END
