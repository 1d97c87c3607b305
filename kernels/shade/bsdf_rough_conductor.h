// Rough metal: microfacets that reflect like a conductor. As Mitsuba 3's `roughconductor` with sample_visible, its
// separable shadowing included (see microfacet_lanes.h).
//
// With S of microfacet_lanes.h: f = F D / (S(fix) S(gen)), pdf = D / (2 S(fix)), f cos / pdf = F G1(gen).
#pragma once

#include "kernels/shade/bsdf_conductor.h"
#include "kernels/shade/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind, uint32_t kThisFeature>
struct RoughConductor {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kThisFeature;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
    using Real = typename P::Real;
    const auto normals = Normals<P>::of(input);
    const Vec3<Real> h = fix + gen;
    const Real h2 = length2(h);
    const Mask front = (fix.z > Real(0)) & (gen.z > Real(0)) & (h2 > Real(kSmallestHalfVector2));
    const Real density = normals.density(h, h2);
    const Real byFix = reciprocal(normals.masking(fix)), byGen = reciprocal(normals.masking(gen));
    // fix . m = |h| / 2 for unit fix and gen.
    const Vec3<Real> reflectance = conductorReflectance(input, Real(0.5) * sqrt(h2));
    return {zeroUnless(front, reflectance * (density * byFix * byGen)),
            zeroUnless(front, Real(0.5) * density * byFix * normals.densityFactor(fix)),
            zeroUnless(front, Real(0.5) * density * byGen * normals.densityFactor(gen))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> fix, const Uniform4& u) {
    using Real = typename P::Real;
    const auto normals = Normals<P>::of(input);
    const Vec3<Real> m = normals.sampleVisible(fix, to<Real>(u.b), to<Real>(u.c));
    const Real cosine = dot(fix, m);
    const Vec3<Real> gen = mirror(fix, m, cosine);
    const Mask front = (fix.z > Real(0)) & (gen.z > Real(0));
    const Real density = Real(0.5) * normals.density(m, Real(1));
    const Real byFix = reciprocal(normals.masking(fix)), byGen = reciprocal(normals.masking(gen));
    const Real shadowing = Real(2) * gen.z * byGen * normals.weightFactor(fix);
    return {.gen = gen,
            .weight = zeroUnless(front, conductorReflectance(input, cosine) * shadowing),
            .pdf = density * byFix * normals.densityFactor(fix),
            .pdfReverse = density * byGen * normals.densityFactor(gen),
            .etaRatio = Real(1),
            .specular = noLanes()};
  }
};

using RoughConductorBsdf = RoughConductor<GgxNormals, BsdfKind::roughConductor, kSpecularBsdfs>;

WAVECREST_SIMD_END
