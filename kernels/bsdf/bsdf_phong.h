// The modified Phong model: a cosine-power lobe around the mirror direction and a diffuse lobe (Lafortune and Willems,
// "Using the Modified Phong Reflectance Model for Physically Based Rendering", 1994). As Mitsuba 0.6's `phong`.
//
// f = k_d / pi + k_s (n+2) / (2 pi) cos^n a, with a the angle between wo and the mirror image of wi. k_s is the
// lobe's albedo at normal incidence only: at grazing angles a part of it lies below the horizon and is lost.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

struct PhongBsdf {
  static constexpr BsdfKind kKind = BsdfKind::phong;
  static constexpr uint32_t kFeature = kLayeredBsdfs;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Real zero(0), one(1);
    const Mask front = (wi.z > zero) & (wo.z > zero);
    const Real exponent = input.alpha();
    // 1 - cos a = |wo - mirror|^2 / 2 keeps its digits in narrow lobes.
    const Real oneMinusCos = Real(0.5) * length2(Vec3<Real>{wo.x + wi.x, wo.y + wi.y, wo.z - wi.z});
    const Real power = exp(exponent * log1p(-min(oneMinusCos, Real(0.999999f))));
    const Real lobe = zeroUnless(oneMinusCos < one, power * Real(kInvPi / 2));
    const Vec3<Real> f = mulAdd(input.specular(), (exponent + Real(2)) * lobe, input.reflectance() * Real(kInvPi));
    const Real pick = to<Real>(input.at(input.materials->specularPick));
    const Real fromLobe = pick * (exponent + one) * lobe, diffuse = (one - pick) * Real(kInvPi);
    return {zeroUnless(front, f), zeroUnless(front, mulAdd(diffuse, wo.z, fromLobe)),
            zeroUnless(front, mulAdd(diffuse, wi.z, fromLobe))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const Real one(1);
    const Real u1 = to<Real>(u.b), u2 = to<Real>(u.c);
    // cos a = u^(1 / (n+1))
    const Real oneMinusCos = -expm1(log(one - u1) * reciprocal(input.alpha() + one));
    const Frame<Real> around = Frame<Real>::fromNormal({-wi.x, -wi.y, wi.z});
    const Vec3<Real> inLobe = around.toWorld(uniformCone(one, u2, oneMinusCos));
    const Mask specular = to<Real>(u.a) < to<Real>(input.at(input.materials->specularPick));
    const Vec3<Real> wo = select(specular, inLobe, cosineHemisphere<Real>(u1, u2));
    const auto value = eval(input, wi, wo);
    return {.wo = wo,
            .weight = value.f * (abs(wo.z) * reciprocal(max(value.pdf, Real(1e-30f)))),
            .pdf = value.pdf,
            .pdfReverse = value.pdfReverse,
            .etaRatio = one,
            .specular = noLanes()};
  }
};

WAVECREST_SIMD_END
