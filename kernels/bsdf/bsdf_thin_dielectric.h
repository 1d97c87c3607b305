// A thin pane, two parallel smooth boundaries as one surface: light is reflected, or passes straight on. As Mitsuba 3's
// `thindielectric`.
//
// The reflections between the boundaries add up to R' = R + (1-R)^2 R / (1-R^2) = 2 R / (1 + R) (geometric series).
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/bsdf/fresnel_lanes.h"

WAVECREST_SIMD_BEGIN

struct ThinDielectricBsdf : DeltaLobes {
  static constexpr BsdfKind kKind = BsdfKind::thinDielectric;
  static constexpr uint32_t kFeature = kLayeredBsdfs;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    const Real one(1);
    const Real single = fresnelDielectric<P>(abs(wi.z), input.eta()).reflectance;
    const Real reflectance = Real(2) * single * reciprocal(one + single);
    const Mask reflect = to<Real>(u.a) < reflectance;
    const Real pick = select(reflect, reflectance, one - reflectance);
    return {.wo = {-wi.x, -wi.y, select(reflect, wi.z, -wi.z)},
            .weight = select(reflect, input.specular(), input.transmittance()),
            .pdf = pick,
            .pdfReverse = pick,
            .etaRatio = one,
            .specular = allLanes()};
  }
};

WAVECREST_SIMD_END
