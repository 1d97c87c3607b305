// Rough boundary between two dielectrics: microfacets that reflect and refract (Walter et al., "Microfacet Models for
// Refraction through Rough Surfaces", 2007). As Mitsuba 3's `roughdielectric` with sample_visible.
//
// Everything is seen from the side of wi, with eta = eta_wo_side / eta_wi_side; the half vector h = wi + eta' wo,
// eta' = 1 for reflection, has length q. With S of microfacet_lanes.h, F at |wi.m| and K = D |wi.m| |wo.m| / q^2:
//   reflection   f = F D / (S(wi) S(wo))               pdf = F D / (2 S(wi))
//   refraction   f = 4 (1-F) K / (S(wi) S(wo)) * s     pdf = 2 (1-F) eta^2 K / S(wi)     reverse: 2 (1-F) K / S(wo)
// where s = 1 if wi is on the eye's side and eta^2 if wo is: f carries radiance (METHODS: eta_e^2). Reflection is the
// case 4 K = D of the same formulas, since q = 2 |wi.m| = 2 |wo.m|; both share one evaluation.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/bsdf/fresnel_lanes.h"
#include "kernels/bsdf/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind>
struct RoughDielectric {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const auto normals = Normals<P>::of(input);
    const Real eta = etaBeyond(input, wi);
    const Mask reflect = (wi.z * wo.z) > zero;
    const Real stretch = select(reflect, one, eta);

    const Vec3<Real> h = mulAdd(wo, stretch, wi);
    const Real h2 = length2(h);
    const Real inverseLength = reciprocalSqrt(max(h2, Real(kSmallestHalfVector2)));
    // Cosines to the normal on wi's side of the surface: positive for wi, and for wo where it reflects.
    const Real orient = copySign(inverseLength, h.z * wi.z);
    const Real wiCosine = dot(wi, h) * orient, woCosine = dot(wo, h) * orient;
    const Mask possible = (h2 > Real(kSmallestHalfVector2)) & (wiCosine > zero) &
                          (select(reflect, woCosine, -woCosine) > zero) & (abs(wi.z * wo.z) > zero);

    const Real reflectance = fresnelDielectric<P>(wiCosine, eta).reflectance;
    const Real share = select(reflect, reflectance, one - reflectance);
    const Real inverseLength2 = inverseLength * inverseLength;
    const Real k = share * normals.density(h, h2) * abs(wiCosine * woCosine) * inverseLength2;
    const Real byWi = reciprocal(normals.masking(wi)), byWo = reciprocal(normals.masking(wo));
    const Real scale = input.walk == Walk::camera ? one : stretch * stretch;
    const Vec3<Real> tint = select(reflect, input.specular(), input.transmittance());
    return {zeroUnless(possible, tint * (Real(4) * k * byWi * byWo * scale)),
            zeroUnless(possible, Real(2) * k * stretch * stretch * byWi * normals.densityFactor(wi)),
            zeroUnless(possible, Real(2) * k * byWo * normals.densityFactor(wo))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const auto normals = Normals<P>::of(input);
    const Real eta = etaBeyond(input, wi);
    const Real inverseEta = reciprocal(eta);
    const Vec3<Real> near{wi.x, wi.y, abs(wi.z)};  // wi as seen from its own side
    const Vec3<Real> m = normals.sampleVisible(wi, to<Real>(u.b), to<Real>(u.c));
    const Real cosine = dot(near, m);
    const auto fresnel = fresnelDielectric<P>(cosine, eta);

    // Reflection about m, or refraction: -near / eta + (cosine / eta - cos theta_t) m, where g = eta cos theta_t.
    const Mask reflect = to<Real>(u.a) < fresnel.reflectance;
    const Real stretch = select(reflect, one, eta), inverseStretch = select(reflect, one, inverseEta);
    const Real alongM = select(reflect, Real(2) * cosine, (cosine - fresnel.g) * inverseEta);
    Vec3<Real> wo = mulAdd(m, alongM, near * -inverseStretch);
    const Mask possible = (select(reflect, wo.z, -wo.z) > zero) & (near.z > zero);

    // |wo.m| = cos theta_t, and q = cosine - g = (1 - eta^2) / (cosine + g) without cancellation.
    const Real woCosine = select(reflect, cosine, fresnel.g * inverseEta);
    const Real q = select(reflect, Real(2) * cosine, (one - eta) * (one + eta) * reciprocal(cosine + fresnel.g));
    const Real share = select(reflect, fresnel.reflectance, one - fresnel.reflectance);
    const Real twoK = Real(2) * share * normals.density(m, one) * cosine * woCosine *
                      reciprocal(max(q * q, Real(kSmallestHalfVector2)));
    const Real byWi = reciprocal(normals.masking(near)), byWo = reciprocal(normals.masking(wo));
    const Real shadowing = Real(2) * abs(wo.z) * byWo * normals.weightFactor(wi);
    const Vec3<Real> tint = select(reflect, input.specular(), input.transmittance());
    wo.z = wo.z * copySign(one, wi.z);
    return {.wo = wo,
            .weight = zeroUnless(possible, tint * (shadowing * radianceScale(input, inverseStretch))),
            .pdf = zeroUnless(possible, twoK * stretch * stretch * byWi * normals.densityFactor(wi)),
            .pdfReverse = twoK * byWo * normals.densityFactor(wo),
            .etaRatio = inverseStretch,
            .specular = noLanes()};
  }

 private:
  // Index on the far side of the boundary over that on wi's side.
  template <class P, bool kTextured>
  static WAVECREST_INLINE typename P::Real etaBeyond(const BsdfInput<P, kTextured>& input, Vec3<typename P::Real> wi) {
    using Real = typename P::Real;
    return select(wi.z > Real(0), input.eta(), reciprocal(input.eta()));
  }
};

using RoughDielectricBsdf = RoughDielectric<GgxNormals, BsdfKind::roughDielectric>;

WAVECREST_SIMD_END
