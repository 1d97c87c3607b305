// Rough conductors and dielectrics with two roughnesses, alpha along dp/du and alpha_v across it. As Mitsuba 3's
// `roughconductor` and `roughdielectric` with alpha_u and alpha_v.
//
// Microfacets with slopes (alpha p, alpha_v q) are those of roughness 1 with slopes (p, q), stretched: a direction v
// sees the ones as (alpha v_x, alpha_v v_y, v_z) sees the others (Heitz, "Understanding the Masking-Shadowing
// Function", 2014, 5.3). S of microfacet_lanes.h grows with the length of its direction as it should. A normal m of the
// surface is (m_x / alpha, m_y / alpha_v, m_z) there, with D smaller by alpha alpha_v.
#pragma once

#include "kernels/bsdf/beckmann_lanes.h"
#include "kernels/bsdf/bsdf_rough_conductor.h"
#include "kernels/bsdf/bsdf_rough_dielectric.h"
#include "kernels/bsdf/compound_input.h"

WAVECREST_SIMD_BEGIN

// A distribution with the interface of microfacet_lanes.h, for directions with x along dp/du; Isotropic: of the same
// shape. The input must be a CompoundInput.
template <template <class> class Isotropic, class P>
struct Stretched {
  using Real = typename P::Real;
  Isotropic<P> unit;
  Real alphaU, alphaV;

  static WAVECREST_INLINE Stretched fromAlphas(Real alphaU, Real alphaV) {
    return {Isotropic<P>::fromAlpha(Real(1)), max(alphaU, Real(kSmallestAlpha)), max(alphaV, Real(kSmallestAlpha))};
  }
  static WAVECREST_INLINE Stretched of(const BsdfInput<P, true>& input) {
    return fromAlphas(input.alpha(),
                      static_cast<const CompoundInput<P>&>(input).parameter(CompoundParameter::alphaV, 1e6f));
  }

  WAVECREST_INLINE Real masking(Vec3<Real> v) const { return unit.masking(stretched(v)); }
  WAVECREST_INLINE Real densityFactor(Vec3<Real> v) const { return unit.densityFactor(stretched(v)); }
  WAVECREST_INLINE Real weightFactor(Vec3<Real> v) const { return unit.weightFactor(stretched(v)); }

  WAVECREST_INLINE Real density(Vec3<Real> h, Real h2) const {
    const Real inverse = reciprocal(alphaU * alphaV);
    return unit.density({h.x * alphaV * inverse, h.y * alphaU * inverse, h.z}, h2) * inverse;
  }
  WAVECREST_INLINE Vec3<Real> sampleVisible(Vec3<Real> v, Real u1, Real u2) const {
    return normalize(stretched(unit.sampleVisible(stretched(v), u1, u2)));
  }

 private:
  WAVECREST_INLINE Vec3<Real> stretched(Vec3<Real> v) const { return {v.x * alphaU, v.y * alphaV, v.z}; }
};
template <class P>
using StretchedGgx = Stretched<GgxNormals, P>;
template <class P>
using StretchedBeckmann = Stretched<BeckmannNormals, P>;

// A BSDF in the frame with x along dp/du.
template <class Bsdf>
struct AlongTangent {
  static constexpr BsdfKind kKind = Bsdf::kKind;
  static constexpr uint32_t kFeature = Bsdf::kFeature;
  static constexpr bool kHasDelta = false;

  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                           Vec3<typename P::Real> wo) {
    return Bsdf::template eval<P>(input, input.toTangent(wi), input.toTangent(wo));
  }
  template <class P>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                              const Uniform4& u) {
    auto sample = Bsdf::template sample<P>(input, input.toTangent(wi), u);
    sample.wo = input.fromTangent(sample.wo);
    return sample;
  }
};

using AnisotropicConductor = AlongTangent<RoughConductor<StretchedGgx, BsdfKind::anisotropicConductor, kCompoundBsdfs>>;
using AnisotropicDielectric = AlongTangent<RoughDielectric<StretchedGgx, BsdfKind::anisotropicDielectric>>;
using AnisotropicBeckmannConductor =
    AlongTangent<RoughConductor<StretchedBeckmann, BsdfKind::anisotropicBeckmannConductor, kCompoundBsdfs>>;
using AnisotropicBeckmannDielectric =
    AlongTangent<RoughDielectric<StretchedBeckmann, BsdfKind::anisotropicBeckmannDielectric>>;

WAVECREST_SIMD_END
