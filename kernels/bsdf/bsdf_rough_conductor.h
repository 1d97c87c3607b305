// Rough metal: microfacets that reflect like a conductor. As Mitsuba 3's `roughconductor` with sample_visible, its
// separable shadowing included (see microfacet_lanes.h).
//
// With S of microfacet_lanes.h: f = F D / (S(wi) S(wo)), pdf = D / (2 S(wi)), f cos / pdf = F G1(wo).
#pragma once

#include "kernels/bsdf/bsdf_conductor.h"
#include "kernels/bsdf/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind, uint32_t kThisFeature>
struct RoughConductor {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kThisFeature;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const auto normals = Normals<P>::of(input);
    const Vec3<Real> h = wi + wo;
    const Real h2 = length2(h);
    const Mask front = (wi.z > Real(0)) & (wo.z > Real(0)) & (h2 > Real(kSmallestHalfVector2));
    const Real density = normals.density(h, h2);
    const Real byWi = reciprocal(normals.masking(wi)), byWo = reciprocal(normals.masking(wo));
    // wi . m = |h| / 2 for unit wi and wo.
    const Vec3<Real> reflectance = conductorReflectance(input, Real(0.5) * sqrt(h2));
    return {zeroUnless(front, reflectance * (density * byWi * byWo)),
            zeroUnless(front, Real(0.5) * density * byWi * normals.densityFactor(wi)),
            zeroUnless(front, Real(0.5) * density * byWo * normals.densityFactor(wo))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const auto normals = Normals<P>::of(input);
    const Vec3<Real> m = normals.sampleVisible(wi, to<Real>(u.b), to<Real>(u.c));
    const Real cosine = dot(wi, m);
    const Vec3<Real> wo = mirror(wi, m, cosine);
    const Mask front = (wi.z > Real(0)) & (wo.z > Real(0));
    const Real density = Real(0.5) * normals.density(m, Real(1));
    const Real byWi = reciprocal(normals.masking(wi)), byWo = reciprocal(normals.masking(wo));
    const Real shadowing = Real(2) * wo.z * byWo * normals.weightFactor(wi);
    return {.wo = wo,
            .weight = zeroUnless(front, conductorReflectance(input, cosine) * shadowing),
            .pdf = zeroUnless(front, density * byWi * normals.densityFactor(wi)),
            .pdfReverse = density * byWo * normals.densityFactor(wo),
            .etaRatio = Real(1),
            .specular = noLanes()};
  }
};

using RoughConductorBsdf = RoughConductor<GgxNormals, BsdfKind::roughConductor, kSpecularBsdfs>;

WAVECREST_SIMD_END
