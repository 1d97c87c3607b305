// Evaluation and sampling of whatever BSDF each lane has: the dispatch over a feature set's kinds.
//
// The contract is in bsdf_interface.h, the list of kinds in bsdf_list.h. Kinds that no lane of a block has are skipped;
// the others run on all lanes and each lane keeps its own result.
#pragma once

#include "kernels/bsdf/bsdf_list.h"
#include "kernels/bsdf/compound_input.h"

WAVECREST_SIMD_BEGIN

template <class Real>
WAVECREST_INLINE BsdfValue<Real> select(Mask m, const BsdfValue<Real>& yes, const BsdfValue<Real>& no) {
  return {select(m, yes.f, no.f), select(m, yes.pdf, no.pdf), select(m, yes.pdfReverse, no.pdfReverse)};
}
template <class Real>
WAVECREST_INLINE BsdfSample<Real> select(Mask m, const BsdfSample<Real>& yes, const BsdfSample<Real>& no) {
  return {select(m, yes.wo, no.wo),
          select(m, yes.weight, no.weight),
          select(m, yes.pdf, no.pdf),
          select(m, yes.pdfReverse, no.pdfReverse),
          select(m, yes.etaRatio, no.etaRatio),
          (yes.specular & m) | andNot(no.specular, m),
          (yes.absent & m) | andNot(no.absent, m)};
}

// What BSDFs of a feature set see of a surface.
template <class P, uint32_t kFeatures>
using BsdfInputOf =
    std::conditional_t<has(kFeatures, kCompoundBsdfs), CompoundInput<P>, BsdfInput<P, has(kFeatures, kTextures)>>;

// Calls function(Bsdf{}, mask of its lanes) for each kind of the feature set that some active lane has. Most kinds are
// absent from the whole scene, which a bit says sooner than a comparison of lanes.
template <uint32_t kFeatures, class P, bool kTextured, class Function, class... Bsdfs>
WAVECREST_INLINE void forEachBsdf(const BsdfInput<P, kTextured>& input, Mask active, Function&& function,
                                  BsdfList<Bsdfs...>) {
  const auto visit = [&](auto bsdf) WAVECREST_LAMBDA {
    using Bsdf = decltype(bsdf);
    if constexpr (Bsdf::kFeature == 0 || has(kFeatures, Bsdf::kFeature)) {
      if ((input.kinds >> static_cast<uint32_t>(Bsdf::kKind) & 1) == 0) return;
      const Mask mine = active & (input.kind == UInt(static_cast<uint32_t>(Bsdf::kKind)));
      if (any(mine)) function(bsdf, mine);
    }
  };
  (visit(Bsdfs{}), ...);
}

// A feature set with nothing but diffuse surfaces needs no dispatch.
constexpr uint32_t kOtherBsdfs = kSpecularBsdfs | kLayeredBsdfs | kCompoundBsdfs;
constexpr bool onlyDiffuse(uint32_t features) { return (features & kOtherBsdfs) == 0; }

// ---- the BSDF without its opacity -----------------------------------------------------------------------------------

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfValue<typename P::Real> evalOpaque(const BsdfInputOf<P, kFeatures>& input, Mask active,
                                                        Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
  BsdfValue<typename P::Real> value = zeroBsdfValue<typename P::Real>();
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine)
          WAVECREST_LAMBDA { value = select(mine, decltype(bsdf)::template eval<P>(input, wi, wo), value); },
      AllBsdfs{});
  return value;
}

// Lanes whose BSDF has no lobe to choose from get weight 0. What samples one kind is not forced inline: that made
// bsdf_general.cpp a quarter longer to compile.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleOpaque(const BsdfInputOf<P, kFeatures>& input, Mask active,
                                                           Vec3<typename P::Real> wi, const Uniform4& u) {
  using Real = typename P::Real;
  const Real zero(0), one(1);
  BsdfSample<Real> sample{{zero, zero, one}, {zero, zero, zero}, one, one, one, noLanes()};
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine) HWY_ATTR {
        if (input.lobes == Lobes::specularOnly && !decltype(bsdf)::kHasDelta) return;
        sample = select(mine, decltype(bsdf)::template sample<P>(input, wi, u), sample);
      },
      AllBsdfs{});
  return sample;
}

// Lanes with a delta lobe, opacity aside.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE Mask opaqueHasDelta(const BsdfInputOf<P, kFeatures>& input, Mask active) {
  Mask delta = noLanes();
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine) WAVECREST_LAMBDA {
        if constexpr (decltype(bsdf)::kHasDelta) delta = delta | mine;
      },
      AllBsdfs{});
  return delta;
}

// ---- what stages call -----------------------------------------------------------------------------------------------

// Evaluation and sampling of the sets that have every BSDF, opacity included; kTextured: with textures (general) or
// without (plain). Every stage shares one copy of them, in bsdf_general.cpp: a dozen BSDFs inlined into each stage
// would cost minutes of compile time for a few per cent of speed.
template <class P, bool kTextured>
BsdfValue<typename P::Real> evalGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                        const Vec3<typename P::Real>& wi, const Vec3<typename P::Real>& wo);
template <class P, bool kTextured>
BsdfSample<typename P::Real> sampleGeneral(const BsdfInput<P, kTextured>& input, Mask active,
                                           const Vec3<typename P::Real>& wi, const Uniform4& u);

// The same of compound BSDFs as well, in bsdf_complete.cpp, for the complete set.
template <class P>
BsdfValue<typename P::Real> evalComplete(const CompoundInput<P>& input, Mask active, const Vec3<typename P::Real>& wi,
                                         const Vec3<typename P::Real>& wo);
template <class P>
BsdfSample<typename P::Real> sampleComplete(const CompoundInput<P>& input, Mask active,
                                            const Vec3<typename P::Real>& wi, const Uniform4& u);

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfValue<typename P::Real> evalBsdf(const BsdfInputOf<P, kFeatures>& input, Mask active,
                                                      Vec3<typename P::Real> wi, Vec3<typename P::Real> wo) {
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::eval<P>(input, wi, wo);
  } else if constexpr (!has(kFeatures, kLayeredBsdfs)) {
    return evalOpaque<P, kFeatures>(input, active, wi, wo);
  } else if constexpr (has(kFeatures, kCompoundBsdfs)) {
    return evalComplete<P>(input, active, wi, wo);
  } else {
    return evalGeneral<P>(input, active, wi, wo);
  }
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleBsdf(const BsdfInputOf<P, kFeatures>& input, Mask active,
                                                         Vec3<typename P::Real> wi, const Uniform4& u) {
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::sample<P>(input, wi, u);
  } else if constexpr (!has(kFeatures, kLayeredBsdfs)) {
    return sampleOpaque<P, kFeatures>(input, active, wi, u);
  } else if constexpr (has(kFeatures, kCompoundBsdfs)) {
    return sampleComplete<P>(input, active, wi, u);
  } else {
    return sampleGeneral<P>(input, active, wi, u);
  }
}

WAVECREST_SIMD_END
