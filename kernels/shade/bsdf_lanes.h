// Evaluation and sampling of whatever BSDF each lane has: the dispatch over a feature set's kinds.
//
// The contract is in bsdf_interface.h, the list of kinds in bsdf_list.h. Kinds that no lane of a block has are skipped;
// the others run on all lanes and each lane keeps its own result.
#pragma once

#include "kernels/shade/bsdf_list.h"

WAVECREST_SIMD_BEGIN

template <class Real>
WAVECREST_INLINE BsdfValue<Real> select(Mask m, const BsdfValue<Real>& yes, const BsdfValue<Real>& no) {
  return {select(m, yes.f, no.f), select(m, yes.pdf, no.pdf), select(m, yes.pdfReverse, no.pdfReverse)};
}
template <class Real>
WAVECREST_INLINE BsdfSample<Real> select(Mask m, const BsdfSample<Real>& yes, const BsdfSample<Real>& no) {
  return {select(m, yes.gen, no.gen),           select(m, yes.weight, no.weight),
          select(m, yes.pdf, no.pdf),           select(m, yes.pdfReverse, no.pdfReverse),
          select(m, yes.etaRatio, no.etaRatio), (yes.specular & m) | andNot(no.specular, m)};
}

// Calls function(Bsdf{}, mask of its lanes) for each kind of the feature set that some active lane has.
template <uint32_t kFeatures, class P, class Function, class... Bsdfs>
WAVECREST_INLINE void forEachBsdf(const BsdfInput<P>& input, Mask active, Function&& function, BsdfList<Bsdfs...>) {
  const auto visit = [&](auto bsdf) HWY_ATTR {
    using Bsdf = decltype(bsdf);
    if constexpr (Bsdf::kFeature == 0 || has(kFeatures, Bsdf::kFeature)) {
      const Mask mine = active & (input.kind == UInt(static_cast<uint32_t>(Bsdf::kKind)));
      if (any(mine)) function(bsdf, mine);
    }
  };
  (visit(Bsdfs{}), ...);
}

// A feature set with nothing but diffuse surfaces needs no dispatch.
constexpr bool onlyDiffuse(uint32_t features) { return (features & (kSpecularBsdfs | kLayeredBsdfs)) == 0; }

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfValue<typename P::Real> evalBsdf(const BsdfInput<P>& input, Mask active,
                                                      Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
  using Real = typename P::Real;
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::eval<P>(input, fix, gen);
  } else {
    BsdfValue<Real> value = zeroBsdfValue<Real>();
    forEachBsdf<kFeatures>(
        input, active,
        [&](auto bsdf, Mask mine)
            HWY_ATTR { value = select(mine, decltype(bsdf)::template eval<P>(input, fix, gen), value); },
        AllBsdfs{});
    return value;
  }
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleBsdf(const BsdfInput<P>& input, Mask active,
                                                         Vec3<typename P::Real> fix, const Uniform4& u) {
  using Real = typename P::Real;
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::sample<P>(input, fix, u);
  } else {
    const Real zero(0), one(1);
    BsdfSample<Real> sample{{zero, zero, one}, {zero, zero, zero}, one, one, one, noLanes()};
    forEachBsdf<kFeatures>(
        input, active,
        [&](auto bsdf, Mask mine)
            HWY_ATTR { sample = select(mine, decltype(bsdf)::template sample<P>(input, fix, u), sample); },
        AllBsdfs{});
    return sample;
  }
}

WAVECREST_SIMD_END
