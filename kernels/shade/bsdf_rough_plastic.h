// Rough plastic: a rough dielectric boundary over a diffuse base. As Mitsuba 3's `roughplastic` with sample_visible.
//
// f = F D / (S(fix) S(gen)) + T(fix) T(gen) rho / (pi eta^2 (1 - X R_inside)), with S of microfacet_lanes.h. T, the
// share of light that a rough boundary lets pass, depends on cos theta alone and comes from a table in the record; the
// specular lobe is chosen as in smooth plastic, with 1 - T in the place of F.
#pragma once

#include "kernels/shade/bsdf_plastic.h"
#include "kernels/shade/microfacet_lanes.h"

WAVECREST_SIMD_BEGIN

template <template <class> class Normals, BsdfKind kThisKind>
struct RoughPlastic {
  static constexpr BsdfKind kKind = kThisKind;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
    return evalFrom(input, Side<P>::from(input, fix), fix, gen);
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> fix, const Uniform4& u) {
    using Real = typename P::Real;
    const auto fixSide = Side<P>::from(input, fix);
    const Real u1 = to<Real>(u.b), u2 = to<Real>(u.c);
    const Vec3<Real> m = Normals<P>::of(input).sampleVisible(fix, u1, u2);
    const Mask specular = to<Real>(u.a) < fixSide.pick;
    const Vec3<Real> gen = select(specular, mirror(fix, m, dot(fix, m)), cosineHemisphere<Real>(u1, u2));
    const auto value = evalFrom(input, fixSide, fix, gen);
    return {.gen = gen,
            .weight = value.f * (abs(gen.z) * reciprocal(max(value.pdf, Real(1e-30f)))),
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
                                                               const Side<P>& fixSide, Vec3<typename P::Real> fix,
                                                               Vec3<typename P::Real> gen) {
    using Real = typename P::Real;
    const Real one(1), half(0.5);
    const auto normals = Normals<P>::of(input);
    const auto genSide = Side<P>::from(input, gen);
    const Vec3<Real> h = fix + gen;
    const Real h2 = length2(h);
    const Mask front = (fix.z > Real(0)) & (gen.z > Real(0)) & (h2 > Real(kSmallestHalfVector2));
    const Real density = normals.density(h, h2);
    const Real byFix = reciprocal(normals.masking(fix)), byGen = reciprocal(normals.masking(gen));
    const Real fresnel = fresnelDielectric<P>(half * sqrt(h2), input.eta()).reflectance;
    const Vec3<Real> f = mulAdd(baseAlbedo(input), fixSide.transmittance * genSide.transmittance * Real(kInvPi),
                                input.specular() * (fresnel * density * byFix * byGen));
    const Real pdf = fixSide.pick * half * density * byFix * normals.densityFactor(fix) +
                     (one - fixSide.pick) * gen.z * Real(kInvPi);
    const Real pdfReverse = genSide.pick * half * density * byGen * normals.densityFactor(gen) +
                            (one - genSide.pick) * fix.z * Real(kInvPi);
    return {zeroUnless(front, f), zeroUnless(front, pdf), zeroUnless(front, pdfReverse)};
  }
};

using RoughPlasticBsdf = RoughPlastic<GgxNormals, BsdfKind::roughPlastic>;

WAVECREST_SIMD_END
