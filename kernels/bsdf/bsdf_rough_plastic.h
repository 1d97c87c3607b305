// Rough plastic: a rough dielectric boundary over a diffuse base. As Mitsuba 3's `roughplastic` with sample_visible.
//
// f = F D / (S(wi) S(wo)) + T(wi) T(wo) rho / (pi eta^2 (1 - X R_inside)), with S of microfacet_lanes.h. T, the
// share of light that a rough boundary lets pass, depends on cos theta alone and comes from a table in the record; the
// specular lobe is chosen as in smooth plastic, with 1 - T in the place of F.
#pragma once

#include "kernels/bsdf/bsdf_plastic.h"
#include "kernels/bsdf/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind>
struct RoughPlastic {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    return evalFrom(input, Side<P>::from(input, wi), wi, wo);
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const auto wiSide = Side<P>::from(input, wi);
    const Real u1 = to<Real>(u.b), u2 = to<Real>(u.c);
    const Vec3<Real> m = Normals<P>::of(input).sampleVisible(wi, u1, u2);
    const Mask specular = to<Real>(u.a) < wiSide.pick;
    const Vec3<Real> wo = select(specular, mirror(wi, m, dot(wi, m)), cosineHemisphere<Real>(u1, u2));
    const auto value = evalFrom(input, wiSide, wi, wo);
    return {.wo = wo,
            .weight = value.f * (abs(wo.z) * reciprocal(max(value.pdf, Real(1e-30f)))),
            .pdf = value.pdf,
            .pdfReverse = value.pdfReverse,
            .etaRatio = Real(1),
            .specular = noLanes()};
  }

 private:
  // What depends on one of the two directions.
  template <class P>
  struct Side {
    using Real = typename P::Real;
    Real transmittance, pick;

    template <bool kTextured>
    static WAVECREST_INLINE Side from(const BsdfInput<P, kTextured>& input, Vec3<Real> v) {
      const Real transmittance = roughTransmittance(input, abs(v.z));
      return {transmittance, specularProbability(input, Real(1) - transmittance)};
    }
  };

  // The record's table, interpolated linearly.
  template <class P, bool kTextured>
  static WAVECREST_INLINE typename P::Real roughTransmittance(const BsdfInput<P, kTextured>& input,
                                                              typename P::Real cosine) {
    using Real = typename P::Real;
    const Real x = min(cosine, Real(1)) * Real(static_cast<float>(kTransmittanceSize - 1));
    const UInt index = min(toUInt(toFloat(x)), UInt(kTransmittanceSize - 2));
    const Real low = to<Real>(input.at(input.materials->roughTransmittance, index));
    const Real high = to<Real>(input.at(input.materials->roughTransmittance, index + UInt(1u)));
    return mulAdd(high - low, x - to<Real>(toFloat(index)), low);
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> evalFrom(const BsdfInput<P, kTextured>& input,
                                                               const Side<P>& wiSide, Vec3<typename P::Real> wi,
                                                               Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real one(1), half(0.5);
    const auto normals = Normals<P>::of(input);
    const auto woSide = Side<P>::from(input, wo);
    const Vec3<Real> h = wi + wo;
    const Real h2 = length2(h);
    const Mask front = (wi.z > Real(0)) & (wo.z > Real(0)) & (h2 > Real(kSmallestHalfVector2));
    const Real density = normals.density(h, h2);
    const Real byWi = reciprocal(normals.masking(wi)), byWo = reciprocal(normals.masking(wo));
    const Real fresnel = fresnelDielectric<P>(half * sqrt(h2), input.eta()).reflectance;
    const Vec3<Real> f = mulAdd(baseAlbedo(input), wiSide.transmittance * woSide.transmittance * Real(kInvPi),
                                input.specular() * (fresnel * density * byWi * byWo));
    const Real pdf =
        wiSide.pick * half * density * byWi * normals.densityFactor(wi) + (one - wiSide.pick) * wo.z * Real(kInvPi);
    const Real pdfReverse =
        woSide.pick * half * density * byWo * normals.densityFactor(wo) + (one - woSide.pick) * wi.z * Real(kInvPi);
    return {zeroUnless(front, f), zeroUnless(front, pdf), zeroUnless(front, pdfReverse)};
  }
};

using RoughPlasticBsdf = RoughPlastic<GgxNormals, BsdfKind::roughPlastic>;

WAVECREST_SIMD_END
