// Smooth metal and perfect mirror: one delta lobe that reflects with the Fresnel reflectance times a colour. As
// Mitsuba 3's `conductor`; its material "none" is eta = 0, k = 1, whose reflectance is exactly 1.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/bsdf/fresnel_lanes.h"

WAVECREST_SIMD_BEGIN

template <class P, bool kTextured>
WAVECREST_INLINE Vec3<typename P::Real> conductorReflectance(const BsdfInput<P, kTextured>& input,
                                                             typename P::Real cosine) {
  using Real = typename P::Real;
  return input.specular() *
         fresnelConductor<P>(cosine, to<Real>(input.at(input.materials->eta)), to<Real>(input.at(input.materials->k)));
}

struct ConductorBsdf : DeltaLobes {
  static constexpr BsdfKind kKind = BsdfKind::conductor;
  static constexpr uint32_t kFeature = kSpecularBsdfs;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4&) {
    using Real = typename P::Real;
    const Mask front = wi.z > Real(0);
    return {.wo = {-wi.x, -wi.y, wi.z},
            .weight = zeroUnless(front, conductorReflectance(input, abs(wi.z))),
            .pdf = Real(1),
            .pdfReverse = Real(1),
            .etaRatio = Real(1),
            .specular = allLanes()};
  }
};

WAVECREST_SIMD_END
