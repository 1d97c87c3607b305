// Evaluation and sampling of every BSDF that is not a compound one, opacity included, for the feature sets that have
// them all, with and without textures.
#include "kernels/bsdf/bsdf_lanes.h"
#include "kernels/bsdf/opacity_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// Features of every BSDF here, with and without textures.
template <bool kTextured>
constexpr uint32_t kAll = kSpecularBsdfs | kLayeredBsdfs | (kTextured ? kTextures : 0u);

}  // namespace

template <class P, bool kTextured>
BsdfValue<typename P::Real> evalGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                        const Vec3<typename P::Real>& wi, const Vec3<typename P::Real>& wo) {
  return scaled(evalOpaque<P, kAll<kTextured>>(input, active, wi, wo), input.opacity());
}

template <class P, bool kTextured>
BsdfSample<typename P::Real> sampleGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                           const Vec3<typename P::Real>& wi, const Uniform4& u) {
  return sampleWithOpacity(
      input, active, wi, u, [&]() WAVECREST_LAMBDA { return opaqueHasDelta<P, kAll<kTextured>>(input, active); },
      [&](const Uniform4& rest) WAVECREST_LAMBDA { return sampleOpaque<P, kAll<kTextured>>(input, active, wi, rest); });
}

#define WAVECREST_INSTANTIATE_BSDFS(P, TEXTURED)                                                        \
  template BsdfValue<P::Real> evalGeneral(const BsdfInput<P, TEXTURED>&, Mask, const Vec3<P::Real>&,    \
                                          const Vec3<P::Real>&);                                        \
  template BsdfSample<P::Real> sampleGeneral(const BsdfInput<P, TEXTURED>&, Mask, const Vec3<P::Real>&, \
                                             const Uniform4&);
WAVECREST_INSTANTIATE_BSDFS(FloatPrecision, true)
WAVECREST_INSTANTIATE_BSDFS(DoublePrecision, true)
#ifndef WAVECREST_ONLY_COMPLETE_KERNELS
WAVECREST_INSTANTIATE_BSDFS(FloatPrecision, false)
#endif
#undef WAVECREST_INSTANTIATE_BSDFS

WAVECREST_SIMD_END
