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

// ---- the BSDF without its opacity -----------------------------------------------------------------------------------

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfValue<typename P::Real> evalOpaque(const BsdfInput<P>& input, Mask active,
                                                        Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
  BsdfValue<typename P::Real> value = zeroBsdfValue<typename P::Real>();
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine)
          HWY_ATTR { value = select(mine, decltype(bsdf)::template eval<P>(input, fix, gen), value); },
      AllBsdfs{});
  return value;
}

// Lanes whose BSDF has no lobe to choose from get weight 0.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleOpaque(const BsdfInput<P>& input, Mask active,
                                                           Vec3<typename P::Real> fix, const Uniform4& u) {
  using Real = typename P::Real;
  const Real zero(0), one(1);
  BsdfSample<Real> sample{{zero, zero, one}, {zero, zero, zero}, one, one, one, noLanes()};
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine) HWY_ATTR {
        if (input.lobes == Lobes::specularOnly && !decltype(bsdf)::kHasDelta) return;
        sample = select(mine, decltype(bsdf)::template sample<P>(input, fix, u), sample);
      },
      AllBsdfs{});
  return sample;
}

// Lanes with a delta lobe, opacity aside.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE Mask opaqueHasDelta(const BsdfInput<P>& input, Mask active) {
  Mask delta = noLanes();
  forEachBsdf<kFeatures>(
      input, active,
      [&](auto bsdf, Mask mine) HWY_ATTR {
        if constexpr (decltype(bsdf)::kHasDelta) delta = delta | mine;
      },
      AllBsdfs{});
  return delta;
}

// ---- what stages call -----------------------------------------------------------------------------------------------
// Opacity o, as Mitsuba 3's `mask`: the surface is absent with probability 1 - o. That is one more delta lobe, which
// passes straight on; the others are scaled by o. To a shadow ray the surface is solid: light that passes is found by
// continuing the path.

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfValue<typename P::Real> evalBsdf(const BsdfInput<P>& input, Mask active,
                                                      Vec3<typename P::Real> fix, Vec3<typename P::Real> gen) {
  using Real = typename P::Real;
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::eval<P>(input, fix, gen);
  } else if constexpr (!has(kFeatures, kLayeredBsdfs)) {
    return evalOpaque<P, kFeatures>(input, active, fix, gen);
  } else {
    const BsdfValue<Real> value = evalOpaque<P, kFeatures>(input, active, fix, gen);
    const Real opacity = input.opacity();
    return {value.f * opacity, value.pdf * opacity, value.pdfReverse * opacity};
  }
}

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

template <class P, uint32_t kFeatures>
WAVECREST_INLINE BsdfSample<typename P::Real> sampleBsdf(const BsdfInput<P>& input, Mask active,
                                                         Vec3<typename P::Real> fix, const Uniform4& u) {
  using Real = typename P::Real;
  if constexpr (onlyDiffuse(kFeatures)) {
    return DiffuseBsdf::sample<P>(input, fix, u);
  } else if constexpr (!has(kFeatures, kLayeredBsdfs)) {
    return sampleOpaque<P, kFeatures>(input, active, fix, u);
  } else {
    const Real one(1);
    const Real opacity = input.opacity();
    const Mask partial = active & (opacity < one);
    if (none(partial)) return sampleOpaque<P, kFeatures>(input, active, fix, u);

    // The probability that the surface is there; among delta lobes alone it counts only if the surface has one.
    Real pick = opacity;
    if (input.lobes == Lobes::specularOnly) pick = zeroUnless(opaqueHasDelta<P, kFeatures>(input, active), opacity);
    const Mask passes = partial & (to<Real>(u.a) >= pick);
    // What is left of u.a decides between the surface's lobes.
    const Float rest = min(u.a / max(toFloat(pick), Float(0x1p-24f)), Float(0x1.fffffep-1f));
    BsdfSample<Real> sample =
        sampleOpaque<P, kFeatures>(input, active, fix, {select(partial, rest, u.a), u.b, u.c, u.d});
    sample.pdf = select(partial, sample.pdf * pick, sample.pdf);
    sample.pdfReverse = select(partial, sample.pdfReverse * pick, sample.pdfReverse);
    const Real absent = one - pick;
    return select(passes, passThrough<P>(fix, (one - opacity) / max(absent, Real(1e-30f)), absent), sample);
  }
}

WAVECREST_SIMD_END
