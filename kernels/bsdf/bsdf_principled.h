// Mitsuba 3's `principled`: diffuse lobes and sheen, a clear coat, and a rough boundary that is a mixture of metal,
// tinted dielectric and glass.
//
// From below only glass is seen. Lobes are chosen in proportion to 1 for the boundary, a quarter of the clear coat, and
// the share of the diffuse lobes, which does not depend on directions; the boundary reflects with probability
// 1 - glass (1 - F) from above and F from below. Half vectors and formulas as in bsdf_rough_dielectric.h.
#pragma once

#include "kernels/bsdf/principled_lanes.h"

WAVECREST_SIMD_BEGIN

struct PrincipledBsdf {
  static constexpr BsdfKind kKind = BsdfKind::principled;
  static constexpr uint32_t kFeature = kCompoundBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                           Vec3<typename P::Real> wo) {
    return evalTurned(input, Numbers<P>(input), input.toTangent(wi), input.toTangent(wo));
  }

  template <class P>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                              const Uniform4& u) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const Numbers<P> numbers(input);
    const Vec3<Real> from = input.toTangent(wi);
    const Mask above = from.z > zero;
    const Real u1 = to<Real>(u.b), u2 = to<Real>(u.c);

    // Which lobe.
    const Real chosen = to<Real>(u.a) * numbers.total(above);
    const Mask diffuse = above & (chosen < numbers.diffuse);
    const Mask coat = andNot(above & (chosen < numbers.diffuse + numbers.coatPick), diffuse);
    const Real rest = select(above, chosen - (numbers.diffuse + numbers.coatPick), chosen);

    // The boundary reflects about a visible normal, or refracts.
    const Vec3<Real> near{from.x, from.y, abs(from.z)};
    const Vec3<Real> m = select(coat, numbers.sampleCoat(u1, u2), numbers.normals.sampleVisible(from, u1, u2));
    const Real cosine = dot(near, m);
    const Real eta = numbers.etaBeyond(above);
    const auto fresnel = fresnelDielectric<P>(max(cosine, zero), eta);
    const Mask reflect = coat | (rest < numbers.reflectPick(above, fresnel.reflectance));
    const Real inverseEta = one / eta;
    const Real alongM = select(reflect, Real(2) * cosine, (cosine - fresnel.g) * inverseEta);
    Vec3<Real> wo = mulAdd(m, alongM, near * -select(reflect, one, inverseEta));
    wo.z = wo.z * copySign(one, from.z);
    wo = select(diffuse, cosineHemisphere<Real>(u1, u2), wo);

    const Mask same = diffuse | reflect;
    const Mask valid = (select(same, from.z * wo.z, -(from.z * wo.z)) > zero) & (diffuse | (cosine > zero));
    const BsdfValue<Real> value = evalTurned(input, numbers, from, wo);
    return {.wo = input.fromTangent(wo),
            .weight = zeroUnless(valid, value.f * (abs(wo.z) / max(value.pdf, Real(1e-30f)))),
            .pdf = zeroUnless(valid, value.pdf),
            .pdfReverse = value.pdfReverse,
            .etaRatio = select(same, one, inverseEta),
            .specular = noLanes()};
  }

 private:
  template <class P>
  struct Numbers {
    using Real = typename P::Real;
    Vec3<Real> base;
    Real roughness, metallic, eta;
    Real diffuse, glass;  // shares of the diffuse lobes and of transmission
    Real coat, coatPick, coatAlpha2;
    StretchedGgx<P> normals;

    explicit WAVECREST_INLINE Numbers(const CompoundInput<P>& input)
        : base(input.reflectance()),
          roughness(input.alpha()),
          metallic(input.parameter(CompoundParameter::metallic)),
          eta(input.eta()),
          normals(principledNormals<P>(roughness, input.parameter(CompoundParameter::anisotropic))) {
      const Real one(1), transmits = input.parameter(CompoundParameter::specTrans);
      diffuse = (one - metallic) * (one - transmits);
      glass = (one - metallic) * transmits;
      coat = input.parameter(CompoundParameter::clearcoat);
      coatPick = Real(0.25f) * coat;
      const Real alpha = mix(Real(0.1f), Real(0.001f), input.parameter(CompoundParameter::clearcoatGloss));
      coatAlpha2 = alpha * alpha;
    }
    WAVECREST_INLINE Real total(Mask above) const { return select(above, diffuse + coatPick + Real(1), Real(1)); }
    WAVECREST_INLINE Real etaBeyond(Mask above) const { return select(above, eta, Real(1) / eta); }
    WAVECREST_INLINE Real reflectPick(Mask above, Real fresnel) const {
      return select(above, Real(1) - glass * (Real(1) - fresnel), fresnel);
    }
    WAVECREST_INLINE Real transmitPick(Mask above, Real fresnel) const {
      return select(above, glass * (Real(1) - fresnel), Real(1) - fresnel);
    }
    // GTR1: D = (a^2 - 1) / (pi ln a^2 (1 + (a^2 - 1) cos^2)), sampled in proportion to D cos (Burley 2012, B.2):
    // cos^2 = (1 - a^(2 (1 - u))) / (1 - a^2). Where the lobe is narrow, 1 - cos^2 has few digits. So the sum in D is
    // a^2 cos^2 + sin^2, and the draw is sin^2 = a^2 (a^(-2 u) - 1) / (1 - a^2).
    WAVECREST_INLINE Real coatDensity(Real cos2, Real sin2) const {
      return (coatAlpha2 - Real(1)) * Real(kInvPi) / (log(coatAlpha2) * mulAdd(coatAlpha2, cos2, sin2));
    }
    WAVECREST_INLINE Vec3<Real> sampleCoat(Real u1, Real u2) const {
      const Real one(1);
      const Real sin2 = min(coatAlpha2 * expm1(-log(coatAlpha2) * u1) / (one - coatAlpha2), one);
      const Real sine = sqrt(sin2);
      const SinCos<Real> azimuth = sinCos2Pi(u2);
      return {sine * azimuth.cos, sine * azimuth.sin, sqrt(one - sin2)};
    }
  };

  // G1 of the clear coat, which is that of GGX of roughness 1/4.
  template <class P>
  static WAVECREST_INLINE typename P::Real coatShadowing(Vec3<typename P::Real> v) {
    using Real = typename P::Real;
    const Real z2 = v.z * v.z;
    return Real(2) * abs(v.z) / (abs(v.z) + sqrt(mulAdd(Real(0.0625f), Real(1) - z2, z2)));
  }

  // What is reflected above the surface by metal, tinted and plain dielectric, at cos theta to the microfacet.
  template <class P>
  static WAVECREST_INLINE Vec3<typename P::Real> reflectance(const CompoundInput<P>& input, const Numbers<P>& numbers,
                                                             Vec3<typename P::Real> tint, typename P::Real fresnel,
                                                             typename P::Real cosine) {
    using Real = typename P::Real;
    const Real one(1), specTint = input.parameter(CompoundParameter::specTint);
    const Real white = schlickShare(cosine, numbers.eta), dielectric = one - numbers.metallic;
    const Real f0 = normalReflectance(numbers.eta);
    const auto channel = [&](Real base, Real tinted) WAVECREST_LAMBDA {
      return numbers.metallic * mix(base, one, white) +
             dielectric * mix(fresnel, mix(tinted * f0, one, white), specTint);
    };
    return {channel(numbers.base.x, tint.x), channel(numbers.base.y, tint.y), channel(numbers.base.z, tint.z)};
  }

  // Of directions with x along dp/du.
  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> evalTurned(const CompoundInput<P>& input,
                                                                 const Numbers<P>& numbers, Vec3<typename P::Real> wi,
                                                                 Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const Mask above = wi.z > zero, woAbove = wo.z > zero;
    const Mask reflect = (wi.z * wo.z) > zero;
    const Real eta = numbers.etaBeyond(above), stretch = select(reflect, one, eta);

    // The microfacet: cosines to its normal on wi's side.
    const Vec3<Real> h = mulAdd(wo, stretch, wi);
    const Real h2 = length2(h);
    const Real inverseLength = reciprocalSqrt(max(h2, Real(kSmallestHalfVector2)));
    const Real orient = copySign(inverseLength, h.z * wi.z);
    const Real wiCosine = dot(wi, h) * orient, woCosine = dot(wo, h) * orient;
    const Mask possible = (h2 > Real(kSmallestHalfVector2)) & (wiCosine > zero) &
                          (select(reflect, woCosine, -woCosine) > zero) & (abs(wi.z * wo.z) > zero);
    const Real fresnel = fresnelDielectric<P>(max(wiCosine, zero), eta).reflectance;
    const Real density = numbers.normals.density(h, h2);
    const Real k = density * abs(wiCosine * woCosine) * inverseLength * inverseLength;  // D / 4 where it reflects
    const Real byWi = reciprocal(numbers.normals.masking(wi)), byWo = reciprocal(numbers.normals.masking(wo));

    // The boundary.
    const Vec3<Real> tint = tintOf(numbers.base);
    const Vec3<Real> reflected =
        select(above, reflectance(input, numbers, tint, fresnel, wiCosine), grey(numbers.glass * fresnel));
    const Real through = numbers.glass * (one - fresnel) * (input.walk == Walk::camera ? one : stretch * stretch);
    const auto tinted = [&](Real base) WAVECREST_LAMBDA { return sqrt(max(base, zero)) * through; };
    const Vec3<Real> transmitted{tinted(numbers.base.x), tinted(numbers.base.y), tinted(numbers.base.z)};
    const Mask visible = possible & (!reflect | (fresnel > zero)) & (above | (numbers.glass > zero));
    Vec3<Real> f = zeroUnless(visible, select(reflect, reflected, transmitted) * (Real(4) * k * byWi * byWo));

    // The layers that only those above see.
    const Mask front = above & woAbove;
    const Real inverseTotal = one / numbers.total(above), inverseWoTotal = one / numbers.total(woAbove);
    const Real coatCosine = abs(h.z) * inverseLength;
    const Real coatSin2 = mulAdd(h.x, h.x, h.y * h.y) * inverseLength * inverseLength;
    const Real coatDensity = numbers.coatDensity(coatCosine * coatCosine, coatSin2);
    const Real coatPdf = coatDensity * coatCosine * reciprocal(max(Real(4) * wiCosine, Real(1e-12f)));
    const Real diffuse =
        numbers.diffuse * Real(kInvPi) *
        principledDiffuse(numbers.roughness, input.parameter(CompoundParameter::flatness), wi.z, wo.z, wiCosine);
    const Real coatFresnel = mix(Real(0.04f), one, schlickShare(wiCosine, numbers.eta));
    // G1(wi) G1(wo), as 2 |v_z| / S.
    const Real coat = zeroUnless(
        possible, numbers.coatPick * coatFresnel * coatDensity * coatShadowing<P>(wi) * coatShadowing<P>(wo));
    const Vec3<Real> sheen = principledSheen(input.parameter(CompoundParameter::sheen) * (one - numbers.metallic),
                                             input.parameter(CompoundParameter::sheenTint), tint, wiCosine);
    f = f + zeroUnless(front, numbers.base * diffuse + sheen + grey(coat));

    const Real pick = select(reflect, numbers.reflectPick(above, fresnel), numbers.transmitPick(above, fresnel));
    // Seen from wo the microfacet reflects as much; what transmits has the other side's share.
    const Real woPick = select(reflect, pick, numbers.transmitPick(woAbove, fresnel));
    const auto layers = [&](Real cosine) WAVECREST_LAMBDA {
      return zeroUnless(front,
                        numbers.diffuse * cosine * Real(kInvPi) + zeroUnless(possible, numbers.coatPick * coatPdf));
    };
    const Real wiPdf = zeroUnless(possible, pick * Real(2) * k * stretch * stretch * byWi);
    const Real woPdf = zeroUnless(possible, woPick * Real(2) * k * byWo);
    const Real pdf = (wiPdf + layers(wo.z)) * inverseTotal, pdfReverse = (woPdf + layers(wi.z)) * inverseWoTotal;
    // Below, where nothing transmits, there is nothing to sample.
    return {f, zeroUnless(above | (numbers.glass > zero), pdf),
            zeroUnless(woAbove | (numbers.glass > zero), pdfReverse)};
  }
};

WAVECREST_SIMD_END
