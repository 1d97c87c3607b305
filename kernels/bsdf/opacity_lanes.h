// Opacity o, as Mitsuba 3's `mask`, of materials without passages (passage_lanes.h), such as those of surfaces that
// shine: the surface is absent with probability 1 - o. That is one more delta lobe, which passes straight on; the
// others are scaled by o.
#pragma once

#include "kernels/bsdf/bsdf_interface.h"

WAVECREST_SIMD_BEGIN

template <class Real>
WAVECREST_INLINE BsdfValue<Real> scaled(const BsdfValue<Real>& value, Real opacity) {
  return {value.f * opacity, value.pdf * opacity, value.pdfReverse * opacity};
}

template <class Real>
WAVECREST_INLINE BsdfSample<Real> passThrough(Vec3<Real> wi, Real weight, Real pick) {
  return {.wo = -wi,
          .weight = {weight, weight, weight},
          .pdf = pick,
          .pdfReverse = pick,
          .etaRatio = Real(1),
          .specular = allLanes(),
          .absent = allLanes()};
}

// hasDelta(): lanes whose surface has a delta lobe; sampleSurface(u): a sample of what the surface does where it is.
template <class P, bool kTextured, class HasDelta, class Sample>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleWithOpacity(const BsdfInput<P, kTextured>& input, Mask active,
                                                                const Vec3<typename P::Real>& wi, const Uniform4& u,
                                                                const HasDelta& hasDelta, const Sample& sampleSurface) {
  using Real = typename P::Real;
  const Real one(1);
  const Real opacity = input.opacity();
  const Mask partial = active & (opacity < one);
  Uniform4 rest = u;
  // The probability that the surface is there; among delta lobes alone it counts only if the surface has one.
  Real pick = opacity;
  if (any(partial)) {
    if (input.lobes == Lobes::specularOnly) pick = zeroUnless(hasDelta(), opacity);
    // What is left of u.a decides between the surface's lobes.
    const Float left = min(u.a / max(toFloat(pick), Float(0x1p-24f)), Float(0x1.fffffep-1f));
    rest.a = select(partial, left, u.a);
  }
  BsdfSample<Real> sample = sampleSurface(rest);
  if (none(partial)) return sample;

  const Mask passes = partial & (to<Real>(u.a) >= pick);
  sample.pdf = select(partial, sample.pdf * pick, sample.pdf);
  sample.pdfReverse = select(partial, sample.pdfReverse * pick, sample.pdfReverse);
  const Real absent = one - pick;
  return select(passes, passThrough(wi, (one - opacity) / max(absent, Real(1e-30f)), absent), sample);
}

WAVECREST_SIMD_END
