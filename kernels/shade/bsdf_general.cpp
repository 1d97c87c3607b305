// Evaluation and sampling of every BSDF there is, for the feature sets that have them all, with and without textures.
//
// Opacity o, as Mitsuba 3's `mask`: the surface is absent with probability 1 - o. That is one more delta lobe, which
// passes straight on; the others are scaled by o. To a shadow ray the surface is solid: light that passes is found by
// continuing the path.
#include "kernels/shade/bsdf_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// The feature set that stands for all with the same BSDFs.
template <bool kTextured>
constexpr uint32_t kAll = featuresOf(kTextured ? Specialization::general : Specialization::plain);

template <class P>
WAVECREST_INLINE BsdfSample<typename P::Real> passThrough(Vec3<typename P::Real> fix, typename P::Real weight,
                                                          typename P::Real pick) {
  return {.gen = -fix,
          .weight = {weight, weight, weight},
          .pdf = pick,
          .pdfReverse = pick,
          .etaRatio = typename P::Real(1),
          .specular = allLanes()};
}

}  // namespace

template <class P, bool kTextured>
BsdfValue<typename P::Real> evalGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                        const Vec3<typename P::Real>& fix, const Vec3<typename P::Real>& gen) {
  using Real = typename P::Real;
  const BsdfValue<Real> value = evalOpaque<P, kAll<kTextured>>(input, active, fix, gen);
  const Real opacity = input.opacity();
  return {value.f * opacity, value.pdf * opacity, value.pdfReverse * opacity};
}

template <class P, bool kTextured>
BsdfSample<typename P::Real> sampleGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                           const Vec3<typename P::Real>& fix, const Uniform4& u) {
  using Real = typename P::Real;
  const Real one(1);
  const Real opacity = input.opacity();
  const Mask partial = active & (opacity < one);
  Uniform4 rest = u;
  // The probability that the surface is there; among delta lobes alone it counts only if the surface has one.
  Real pick = opacity;
  if (any(partial)) {
    if (input.lobes == Lobes::specularOnly) {
      pick = zeroUnless(opaqueHasDelta<P, kAll<kTextured>>(input, active), opacity);
    }
    // What is left of u.a decides between the surface's lobes.
    const Float left = min(u.a / max(toFloat(pick), Float(0x1p-24f)), Float(0x1.fffffep-1f));
    rest.a = select(partial, left, u.a);
  }
  BsdfSample<Real> sample = sampleOpaque<P, kAll<kTextured>>(input, active, fix, rest);
  if (none(partial)) return sample;

  const Mask passes = partial & (to<Real>(u.a) >= pick);
  sample.pdf = select(partial, sample.pdf * pick, sample.pdf);
  sample.pdfReverse = select(partial, sample.pdfReverse * pick, sample.pdfReverse);
  const Real absent = one - pick;
  return select(passes, passThrough<P>(fix, (one - opacity) / max(absent, Real(1e-30f)), absent), sample);
}

#define WAVECREST_INSTANTIATE_GENERAL(P, TEXTURED)                                                      \
  template BsdfValue<P::Real> evalGeneral(const BsdfInput<P, TEXTURED>&, Mask, const Vec3<P::Real>&,    \
                                          const Vec3<P::Real>&);                                        \
  template BsdfSample<P::Real> sampleGeneral(const BsdfInput<P, TEXTURED>&, Mask, const Vec3<P::Real>&, \
                                             const Uniform4&);
WAVECREST_INSTANTIATE_GENERAL(FloatPrecision, true)
WAVECREST_INSTANTIATE_GENERAL(DoublePrecision, true)
WAVECREST_INSTANTIATE_GENERAL(FastPrecision, true)
#ifndef WAVECREST_ONLY_GENERAL_KERNELS
WAVECREST_INSTANTIATE_GENERAL(FloatPrecision, false)
#endif
#undef WAVECREST_INSTANTIATE_GENERAL

WAVECREST_SIMD_END
