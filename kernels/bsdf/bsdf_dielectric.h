// Smooth boundary between two dielectrics: two delta lobes, reflection and refraction, chosen by the Fresnel
// reflectance. As Mitsuba 3's `dielectric`.
//
// The outside (z > 0) has the exterior index. The reverse probabilities equal the forward ones because the reflectance
// is the same from either end of a refracted path.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/bsdf/fresnel_lanes.h"

WAVECREST_SIMD_BEGIN

struct DielectricBsdf : DeltaLobes {
  static constexpr BsdfKind kKind = BsdfKind::dielectric;
  static constexpr uint32_t kFeature = kSpecularBsdfs;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const Real one(1);
    const Real eta = input.eta(), inverseEta = reciprocal(eta);
    const Mask outside = wi.z > Real(0);
    const Real etaWiOverWo = select(outside, inverseEta, eta);
    const auto fresnel = fresnelDielectric<P>(abs(wi.z), select(outside, eta, inverseEta));

    // Snell's law scales the tangential part; z is -cos(theta_t) on the other side, from g = eta cos(theta_t).
    const Mask reflect = to<Real>(u.a) < fresnel.reflectance;
    const Real tangential = select(reflect, Real(-1), -etaWiOverWo);
    const Real z = select(reflect, wi.z, copySign(fresnel.g * etaWiOverWo, -wi.z));
    const Real pick = select(reflect, fresnel.reflectance, one - fresnel.reflectance);
    const Real etaRatio = select(reflect, one, etaWiOverWo);
    const Vec3<Real> tint = select(reflect, input.specular(), input.transmittance());
    return {.wo = {wi.x * tangential, wi.y * tangential, z},
            .weight = tint * radianceScale(input, etaRatio),
            .pdf = pick,
            .pdfReverse = pick,
            .etaRatio = etaRatio,
            .specular = allLanes()};
  }
};

WAVECREST_SIMD_END
