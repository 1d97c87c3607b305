// Mitsuba 3's `principledthin`: a sheet without thickness that looks alike from either side, with rough reflection and
// transmission, diffuse reflection with sheen, and diffuse transmission.
//
// Transmission goes straight on, blurred: it is a reflection whose direction is mirrored at the sheet, from microfacets
// of a roughness that depends on the index. Lobes are chosen by their shares, the rough two evenly.
//
// One condition of Mitsuba's transmission tells the eye's side from the light's: the direction to the light must lie
// behind the microfacet. f is therefore not symmetric, but it is one function of light and eye.
#pragma once

#include "kernels/bsdf/principled_lanes.h"

WAVECREST_SIMD_BEGIN

struct PrincipledThinBsdf {
  static constexpr BsdfKind kKind = BsdfKind::principledThin;
  static constexpr uint32_t kFeature = kCompoundBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                           Vec3<typename P::Real> wo) {
    return evalTurned(input, Sheet<P>(input), input.toTangent(wi), input.toTangent(wo));
  }

  template <class P>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const CompoundInput<P>& input, Vec3<typename P::Real> wi,
                                                              const Uniform4& u) {
    using Real = typename P::Real;
    const Real one(1), u1 = to<Real>(u.b), u2 = to<Real>(u.c);
    const Sheet<P> sheet(input);
    const Vec3<Real> from = input.toTangent(wi), near{from.x, from.y, abs(from.z)};
    const Real chosen = to<Real>(u.a);
    const Mask rough = chosen < sheet.rough;
    const Mask through = select(rough, Real(2) * chosen, chosen - sheet.rough) >=
                         select(rough, sheet.rough, (one - sheet.rough) * (one - sheet.through));
    const Vec3<Real> m =
        select(through, sheet.transmission.sampleVisible(near, u1, u2), sheet.reflection.sampleVisible(near, u1, u2));
    Vec3<Real> wo = select(rough, mirror(near, m, dot(near, m)), cosineHemisphere<Real>(u1, u2));
    const Mask upward = wo.z > Real(0);
    wo.z = wo.z * copySign(one, from.z) * select(through, -one, one);
    const BsdfValue<Real> value = evalTurned(input, sheet, from, wo);
    return {.wo = input.fromTangent(wo),
            .weight = zeroUnless(upward, value.f * (abs(wo.z) / max(value.pdf, Real(1e-30f)))),
            .pdf = zeroUnless(upward, value.pdf),
            .pdfReverse = value.pdfReverse,
            .etaRatio = one,
            .specular = noLanes()};
  }

 private:
  template <class P>
  struct Sheet {
    using Real = typename P::Real;
    Vec3<Real> base;
    Real roughness, eta;
    Real rough, through;  // share of the rough lobes; of the diffuse ones, of transmission
    StretchedGgx<P> reflection, transmission;

    explicit WAVECREST_INLINE Sheet(const CompoundInput<P>& input)
        : base(input.reflectance()),
          roughness(input.alpha()),
          eta(input.eta()),
          rough(input.parameter(CompoundParameter::specTrans)),
          through(Real(0.5f) * input.parameter(CompoundParameter::diffTrans, 2)) {
      const Real anisotropic = input.parameter(CompoundParameter::anisotropic);
      reflection = principledNormals<P>(roughness, anisotropic);
      // Burley 2015, figure 15.
      transmission = principledNormals<P>(mulSub(Real(0.65f), eta, Real(0.35f)) * roughness, anisotropic);
    }
  };

  // Of directions with x along dp/du.
  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> evalTurned(const CompoundInput<P>& input, const Sheet<P>& sheet,
                                                                 Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real zero(0), one(1), half(0.5f);
    const Mask reflect = (wi.z * wo.z) > zero;
    const Mask possible = abs(wi.z * wo.z) > zero;
    // The sheet mirrored so that wi is above it, and wo as reflected.
    const Real side = copySign(one, wi.z);
    const Vec3<Real> near = wi * side, far = wo * side, image{far.x, far.y, abs(far.z)};
    const Vec3<Real> h = near + image;
    const Real h2 = length2(h), length = sqrt(h2);
    const Real cosine = half * length;  // of either to the microfacet

    const Real densityR = sheet.reflection.density(h, h2), densityT = sheet.transmission.density(h, h2);
    const Real density = select(reflect, densityR, densityT);
    const Real byNear = reciprocal(select(reflect, sheet.reflection.masking(near), sheet.transmission.masking(near)));
    const Real byFar = reciprocal(select(reflect, sheet.reflection.masking(image), sheet.transmission.masking(image)));
    const Real fresnel = fresnelDielectric<P>(cosine, sheet.eta).reflectance;

    // Rough lobes.
    const Vec3<Real> tint = tintOf(sheet.base);
    const Real specTint = input.parameter(CompoundParameter::specTint);
    const Real white = schlickShare(cosine, sheet.eta), f0 = normalReflectance(sheet.eta);
    const auto tinted = [&](Real channel)
                            WAVECREST_LAMBDA { return mix(fresnel, mix(channel * f0, one, white), specTint); };
    const Vec3<Real> reflected{tinted(tint.x), tinted(tint.y), tinted(tint.z)};
    // Behind the microfacet that the eye's direction sees: h, with the eye above the sheet.
    const Vec3<Real> light = input.walk == Walk::camera ? far : near, eye = input.walk == Walk::camera ? near : far;
    const Real eyeSide = copySign(one, eye.z);
    const Vec3<Real> seen{h.x * eyeSide, h.y * eyeSide, h.z};
    const Mask transmit = dot(light * eyeSide, seen) < zero;
    const Vec3<Real> rough = select(reflect, reflected, zeroUnless(transmit, sheet.base * (one - fresnel)));
    Vec3<Real> f = rough * (sheet.rough * density * byNear * byFar);

    // Diffuse ones.
    const Real matte = one - sheet.rough, front = matte * (one - sheet.through), back = matte * sheet.through;
    const Real diffuse = Real(kInvPi) * principledDiffuse(sheet.roughness, input.parameter(CompoundParameter::flatness),
                                                          near.z, image.z, cosine);
    const Vec3<Real> sheen = principledSheen(input.parameter(CompoundParameter::sheen),
                                             input.parameter(CompoundParameter::sheenTint), tint, cosine);
    f = f + select(reflect, (sheet.base * diffuse + sheen) * front, sheet.base * (back * Real(kInvPi)));

    const Real share = select(reflect, front, back) * Real(kInvPi), roughPdf = Real(0.25f) * sheet.rough * density;
    return {zeroUnless(possible, f), zeroUnless(possible, mulAdd(share, image.z, roughPdf * byNear)),
            zeroUnless(possible, mulAdd(share, near.z, roughPdf * byFar))};
  }
};

WAVECREST_SIMD_END
