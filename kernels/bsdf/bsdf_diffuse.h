// Diffuse reflection, f = rho / pi on the front side (Lambert), sampled in proportion to the cosine.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"
#include "kernels/sampling/warp_lanes.h"

WAVECREST_SIMD_BEGIN

struct DiffuseBsdf {
  static constexpr BsdfKind kKind = BsdfKind::diffuse;
  static constexpr uint32_t kFeature = 0;
  static constexpr bool kHasDelta = false;

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P, kTextured>& input,
                                                           Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
    using Real = typename P::Real;
    const Mask front = (wi.z > Real(0)) & (wo.z > Real(0));
    return {zeroUnless(front, input.reflectance() * Real(kInvPi)), zeroUnless(front, wo.z * Real(kInvPi)),
            zeroUnless(front, wi.z * Real(kInvPi))};
  }

  template <class P, bool kTextured>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P, kTextured>& input,
                                                              Vec3<typename P::Real> wi, const Uniform4& u) {
    using Real = typename P::Real;
    BsdfSample<Real> sample;
    sample.wo = cosineHemisphere<Real>(to<Real>(u.b), to<Real>(u.c));
    sample.weight = zeroUnless(wi.z > Real(0), input.reflectance());
    sample.pdf = sample.wo.z * Real(kInvPi);
    sample.pdfReverse = abs(wi.z) * Real(kInvPi);
    sample.etaRatio = Real(1);
    sample.specular = noLanes();
    return sample;
  }
};

WAVECREST_SIMD_END
