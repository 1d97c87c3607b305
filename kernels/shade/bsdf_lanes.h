// The contract between stages and BSDFs, and the dispatch over a feature set's kinds.
//
// A BSDF works in the shading frame (z along the shading normal): `fix` points back along the path, `gen` is the
// generated direction, both away from the surface. f contains no cosine. Densities are per solid angle, lobe choice
// included, roulette not.
//
// A kind is a struct with
//   static constexpr BsdfKind kKind;  static constexpr uint32_t kFeature;   // 0: part of every feature set
//   template <class P> static BsdfValue<Real> eval(const BsdfInput<P>&, Vec3<Real> fix, Vec3<Real> gen);
//   template <class P> static BsdfSample<Real> sample(const BsdfInput<P>&, Vec3<Real> fix, const Uniform4& u);
// and a place in AllBsdfs. eval covers the non-delta lobes only.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct BsdfValue {
  Vec3<Real> f;     // 0 where the directions lie on sides that this BSDF does not join
  Real pdf;         // of gen given fix
  Real pdfReverse;  // of fix given gen
};

template <class Real>
struct BsdfSample {
  Vec3<Real> gen;
  Vec3<Real> weight;     // f |cos gen| / pdf; for a delta lobe its albedo over the lobe's probability
  Real pdf, pdfReverse;  // of a delta lobe: discrete probabilities
  Real etaRatio;         // eta_fix / eta_gen: 1 unless refracted
  Mask specular;         // a delta lobe was taken
};

// Which way the sub-path is walked: along radiance's way back to its source, or along its flow.
enum class Walk { camera, light };

// What a BSDF may ask about the surface. Constants come from the material record of each lane, times a texture.
template <class P>
struct BsdfInput {
  using Real = typename P::Real;
  const MaterialRecord* materials;
  RecordLanes<MaterialRecord> at;
  UInt kind;
  Walk walk = Walk::camera;

  WAVECREST_INLINE BsdfInput(const MaterialRecord* base, UInt index) : materials(base), at(base, index) {
    kind = at(base->kind);
  }
  WAVECREST_INLINE Vec3<Real> reflectance() const { return to<Real>(at(materials->reflectance)); }
  WAVECREST_INLINE Vec3<Real> specular() const { return to<Real>(at(materials->specular)); }
  WAVECREST_INLINE Vec3<Real> transmittance() const { return to<Real>(at(materials->transmittance)); }
  WAVECREST_INLINE Real alpha() const { return to<Real>(at(materials->alpha)); }
};

// f = rho / pi on the front side.
struct DiffuseBsdf {
  static constexpr BsdfKind kKind = BsdfKind::diffuse;
  static constexpr uint32_t kFeature = 0;

  template <class P>
  static WAVECREST_INLINE BsdfValue<typename P::Real> eval(const BsdfInput<P>& input, Vec3<typename P::Real> fix,
                                                           Vec3<typename P::Real> gen) {
    using Real = typename P::Real;
    const Mask front = (fix.z > Real(0)) & (gen.z > Real(0));
    return {zeroUnless(front, input.reflectance() * Real(kInvPi)), zeroUnless(front, gen.z * Real(kInvPi)),
            zeroUnless(front, fix.z * Real(kInvPi))};
  }

  template <class P>
  static WAVECREST_INLINE BsdfSample<typename P::Real> sample(const BsdfInput<P>& input, Vec3<typename P::Real> fix,
                                                              const Uniform4& u) {
    using Real = typename P::Real;
    BsdfSample<Real> sample;
    sample.gen = cosineHemisphere<Real>(to<Real>(u.b), to<Real>(u.c));
    sample.weight = zeroUnless(fix.z > Real(0), input.reflectance());
    sample.pdf = sample.gen.z * Real(kInvPi);
    sample.pdfReverse = abs(fix.z) * Real(kInvPi);
    sample.etaRatio = Real(1);
    sample.specular = noLanes();
    return sample;
  }
};

WAVECREST_SIMD_END

#include "kernels/shade/bsdf_list.h"

WAVECREST_SIMD_BEGIN

// ---- dispatch over the kinds of a feature set -----------------------------------------------------------------------

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
    const Real zero(0);
    BsdfValue<Real> value{{zero, zero, zero}, zero, zero};
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
