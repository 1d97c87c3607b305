// Rough boundary between two dielectrics: microfacets that reflect and refract (Walter et al., "Microfacet Models for
// Refraction through Rough Surfaces", 2007). As Mitsuba 3's `roughdielectric` with sample_visible.
//
// Everything is seen from the side of fix, with eta = eta_gen_side / eta_fix_side; the half vector h = fix + eta' gen,
// eta' = 1 for reflection, has length q. With S of microfacet_lanes.h, F at |fix.m| and K = D |fix.m| |gen.m| / q^2:
//   reflection   f = F D / (S(fix) S(gen))               pdf = F D / (2 S(fix))
//   refraction   f = 4 (1-F) K / (S(fix) S(gen)) * s     pdf = 2 (1-F) eta^2 K / S(fix)     reverse: 2 (1-F) K / S(gen)
// where s = 1 if fix is on the eye's side and eta^2 if gen is: f carries radiance (METHODS: eta_e^2). Reflection is the
// case 4 K = D of the same formulas, since q = 2 |fix.m| = 2 |gen.m|; both share one evaluation.
#pragma once

#include "kernels/shade/bsdf_interface.h"
#include "kernels/shade/fresnel_lanes.h"
#include "kernels/shade/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind>
struct RoughDielectric {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const auto normals = Normals<P>::of(input);
    const Real eta = etaBeyond(input, fix);
    const Mask reflect = (fix.z * gen.z) > zero;
    const Real stretch = select(reflect, one, eta);

    const Vec3<Real> h = mulAdd(gen, stretch, fix);
    const Real h2 = length2(h);
    const Real inverseLength = reciprocalSqrt(max(h2, Real(kSmallestHalfVector2)));
    // Cosines to the normal on fix's side of the surface: positive for fix, and for gen where it reflects.
    const Real orient = copySign(inverseLength, h.z * fix.z);
    const Real fixCosine = dot(fix, h) * orient, genCosine = dot(gen, h) * orient;
    const Mask possible = (h2 > Real(kSmallestHalfVector2)) & (fixCosine > zero) &
                          (select(reflect, genCosine, -genCosine) > zero) & (abs(fix.z * gen.z) > zero);

    const Real reflectance = fresnelDielectric<P>(fixCosine, eta).reflectance;
    const Real share = select(reflect, reflectance, one - reflectance);
    const Real inverseLength2 = inverseLength * inverseLength;
    const Real k = share * normals.density(h, h2) * abs(fixCosine * genCosine) * inverseLength2;
    const Real byFix = reciprocal(normals.masking(fix)), byGen = reciprocal(normals.masking(gen));
    const Real scale = input.walk == Walk::camera ? one : stretch * stretch;
    const Vec3<Real> tint = select(reflect, input.specular(), input.transmittance());
    return {zeroUnless(possible, tint * (Real(4) * k * byFix * byGen * scale)),
            zeroUnless(possible, Real(2) * k * stretch * stretch * byFix * normals.densityFactor(fix)),
            zeroUnless(possible, Real(2) * k * byGen * normals.densityFactor(gen))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> fix, const Uniform4& u) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const auto normals = Normals<P>::of(input);
    const Real eta = etaBeyond(input, fix);
    const Real inverseEta = reciprocal(eta);
    const Vec3<Real> near{fix.x, fix.y, abs(fix.z)};  // fix as seen from its own side
    const Vec3<Real> m = normals.sampleVisible(fix, to<Real>(u.b), to<Real>(u.c));
    const Real cosine = dot(near, m);
    const auto fresnel = fresnelDielectric<P>(cosine, eta);

    // Reflection about m, or refraction: -near / eta + (cosine / eta - cos theta_t) m, where g = eta cos theta_t.
    const Mask reflect = to<Real>(u.a) < fresnel.reflectance;
    const Real stretch = select(reflect, one, eta), inverseStretch = select(reflect, one, inverseEta);
    const Real alongM = select(reflect, Real(2) * cosine, (cosine - fresnel.g) * inverseEta);
    Vec3<Real> gen = mulAdd(m, alongM, near * -inverseStretch);
    const Mask possible = (select(reflect, gen.z, -gen.z) > zero) & (near.z > zero);

    // |gen.m| = cos theta_t, and q = cosine - g = (1 - eta^2) / (cosine + g) without cancellation.
    const Real genCosine = select(reflect, cosine, fresnel.g * inverseEta);
    const Real q = select(reflect, Real(2) * cosine, (one - eta) * (one + eta) * reciprocal(cosine + fresnel.g));
    const Real share = select(reflect, fresnel.reflectance, one - fresnel.reflectance);
    const Real twoK = Real(2) * share * normals.density(m, one) * cosine * genCosine *
                      reciprocal(max(q * q, Real(kSmallestHalfVector2)));
    const Real byFix = reciprocal(normals.masking(near)), byGen = reciprocal(normals.masking(gen));
    const Real shadowing = Real(2) * abs(gen.z) * byGen * normals.weightFactor(fix);
    const Vec3<Real> tint = select(reflect, input.specular(), input.transmittance());
    gen.z = gen.z * copySign(one, fix.z);
    return {.gen = gen,
            .weight = zeroUnless(possible, tint * (shadowing * radianceScale(input, inverseStretch))),
            .pdf = twoK * stretch * stretch * byFix * normals.densityFactor(fix),
            .pdfReverse = twoK * byGen * normals.densityFactor(gen),
            .etaRatio = inverseStretch,
            .specular = noLanes()};
  }

 private:
  // Index on the far side of the boundary over that on fix's side.
  template <class P, bool kTextured>
  static WAVECREST_INLINE typename P::Real etaBeyond(const BsdfInput<P, kTextured>& input, Vec3<typename P::Real> fix) {
    using Real = typename P::Real;
    return select(fix.z > Real(0), input.eta(), reciprocal(input.eta()));
  }
};

using RoughDielectricBsdf = RoughDielectric<GgxNormals, BsdfKind::roughDielectric>;

WAVECREST_SIMD_END
