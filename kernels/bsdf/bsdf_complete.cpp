// Evaluation and sampling of every BSDF there is, opacity included, for the complete feature set: those of the general
// one by its own code, compound ones and blends of all of them here.
//
// A blend is a material that names others (CompoundRecord). f is the weighted sum of theirs; sampling takes one of them
// with probability proportional to its weight, so the density is the weighted mean of theirs. A delta lobe belongs to
// the part that was taken.
#include "kernels/bsdf/bsdf_lanes.h"
#include "kernels/bsdf/compound_list.h"
#include "kernels/bsdf/opacity_lanes.h"
#include "kernels/bsdf/passage_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// Lanes whose kind is among `kinds`, a bit for each.
WAVECREST_INLINE Mask isAmong(UInt kind, uint32_t kinds) {
  Mask found = noLanes();
  for (uint32_t k = 0; k < 32; ++k) {
    if ((kinds >> k & 1) != 0) found = found | (kind == UInt(k));
  }
  return found;
}

// ---- materials that are no blends -----------------------------------------------------------------------------------

constexpr uint32_t kSingleKinds = kCompoundKinds & ~kBlendKinds;

// f and densities with opacity, of lanes that are no blends: of compound kinds here, of the others by evalGeneral.
template <class P>
WAVECREST_NOINLINE BsdfValue<typename P::Real> evalSingle(const CompoundInput<P>& input, Mask active,
                                                          const Vec3<typename P::Real>& wi,
                                                          const Vec3<typename P::Real>& wo) {
  using Real = typename P::Real;
  const BsdfInput<P, true>& plain = input;
  const Mask compound = active & isAmong(input.kind, input.kinds & kSingleKinds);
  if (none(compound)) return evalGeneral<P>(plain, active, wi, wo);
  BsdfValue<Real> value = zeroBsdfValue<Real>();
  const Mask others = andNot(active, compound);
  if (any(others)) value = evalGeneral<P>(plain, others, wi, wo);
  BsdfValue<Real> own = zeroBsdfValue<Real>();
  forEachBsdf<kAllFeatures>(
      plain, compound,
      [&](auto bsdf, Mask mine)
          WAVECREST_LAMBDA { own = select(mine, decltype(bsdf)::template eval<P>(input, wi, wo), own); },
      CompoundBsdfs{});
  return select(compound, scaled(own, input.opacity()), value);
}

// The same for samples.
template <class P>
WAVECREST_NOINLINE BsdfSample<typename P::Real> sampleSingle(const CompoundInput<P>& input, Mask active,
                                                             const Vec3<typename P::Real>& wi, const Uniform4& u) {
  using Real = typename P::Real;
  const BsdfInput<P, true>& plain = input;
  const Mask compound = active & isAmong(input.kind, input.kinds & kSingleKinds);
  if (none(compound)) return sampleGeneral<P>(plain, active, wi, u);
  const Real zero(0), one(1);
  const BsdfSample<Real> nothing{{zero, zero, one}, {zero, zero, zero}, one, one, one, noLanes()};
  BsdfSample<Real> sample = nothing;
  const Mask others = andNot(active, compound);
  if (any(others)) sample = sampleGeneral<P>(plain, others, wi, u);
  const auto surface = [&](const Uniform4& rest) WAVECREST_LAMBDA {
    BsdfSample<Real> own = nothing;
    if (input.lobes == Lobes::specularOnly) return own;  // no compound kind has delta lobes
    forEachBsdf<kAllFeatures>(
        plain, compound,
        [&](auto bsdf, Mask mine)
            HWY_ATTR { own = select(mine, decltype(bsdf)::template sample<P>(input, wi, rest), own); },
        CompoundBsdfs{});
    return own;
  };
  const auto hasDelta = []() WAVECREST_LAMBDA { return noLanes(); };
  return select(compound, sampleWithOpacity(plain, compound, wi, u, hasDelta, surface), sample);
}

// ---- blends ---------------------------------------------------------------------------------------------------------

// The parts of blends and their weights, in `lanes`. Parts are counted from 0. Lanes may have different numbers of
// parts.
template <class P>
struct Blend {
  using Real = typename P::Real;
  const CompoundInput<P>& input;
  Mask lanes;
  UInt count;  // of parts
  Mask textured;
  Real texture;  // the weight of the second part where there is one
  // Of blends that let light through, whose other vertices are where their parts are: the sum of the weights there.
  Mask passes;
  Real stopping;

  WAVECREST_INLINE Blend(const CompoundInput<P>& blend, Mask active) : input(blend), lanes(active) {
    const CompoundRecord& fields = *input.scene->compounds;
    count = input.compound(fields.partCount);
    const UInt id = input.compound(fields.weightTexture);
    textured = active & (id != UInt(kNoIndex));
    const Vec3<Float> value = textureFactor(input.scene->textures, input.scene->texels,
                                            select(textured, id, UInt(kNoIndex)), input.u, input.v);
    texture = to<Real>(min(max(value.x, Float(0)), Float(1)));
    passes = noLanes();
    if (input.scene->passages == nullptr) return;
    passes = active & ((input.flags & UInt(kPasses)) == UInt(kPasses));
    stopping = Real(0);
    for (uint32_t k = 0; k < kMostParts && any(passes & has(k)); ++k) {
      stopping = stopping + givenWeight(k) * stopOf(k);
    }
  }

  WAVECREST_INLINE Mask has(uint32_t k) const { return lanes & (UInt(k) < count); }
  WAVECREST_INLINE UInt materialOf(uint32_t k) const {
    return select(has(k), input.compound(input.scene->compounds->part[k]), UInt(0u));
  }
  // What a walk meets of part k, if it meets the blend.
  WAVECREST_INLINE Real weightOf(uint32_t k) const {
    const Real weight = givenWeight(k);
    if (none(passes)) return weight;
    return select(passes, weight * stopOf(k) / max(stopping, Real(1e-30f)), weight);
  }
  WAVECREST_INLINE Real stopOf(uint32_t k) const { return passage(k).stop; }
  WAVECREST_INLINE Passage<Real> passage(uint32_t k) const {
    return passageOfOne<P>(*input.scene, materialOf(k), input.u, input.v);
  }
  WAVECREST_INLINE Real givenWeight(uint32_t k) const {
    const Real constant = to<Real>(input.compound(input.scene->compounds->weight[k]));
    return zeroUnless(has(k), select(textured, k == 0 ? Real(1) - texture : texture, constant));
  }
};

// A part as its material asks for it: two-sided parts turn towards wi. Flips z of directions that are given to it, and
// of those that come from it.
template <class P>
struct Part {
  using Real = typename P::Real;
  CompoundInput<P> input;
  Real side;

  WAVECREST_INLINE Part(const CompoundInput<P>& blend, UInt material, Vec3<Real> wi) : input(blend.part(material)) {
    const Mask twoSided = (input.flags & UInt(kTwoSided)) == UInt(kTwoSided);
    side = select(twoSided & (wi.z < Real(0)), Real(-1), Real(1));
  }
  WAVECREST_INLINE Vec3<Real> turned(Vec3<Real> w) const { return {w.x, w.y, w.z * side}; }
};

// f and densities of blends without their opacity. own: the density of the part `chosen`.
template <class P>
WAVECREST_NOINLINE BsdfValue<typename P::Real> evalParts(const Blend<P>& blend, const Vec3<typename P::Real>& wi,
                                                         const Vec3<typename P::Real>& wo, UInt chosen,
                                                         typename P::Real& own) {
  using Real = typename P::Real;
  BsdfValue<Real> sum = zeroBsdfValue<Real>();
  Real total(0);
  own = Real(0);
  for (uint32_t k = 0; k < kMostParts && any(blend.has(k)); ++k) {
    const Real weight = blend.weightOf(k);
    const Mask mine = weight > Real(0);
    const Part<P> part(blend.input, blend.materialOf(k), wi);
    const BsdfValue<Real> value = evalSingle(part.input, mine, part.turned(wi), part.turned(wo));
    sum.f = select(mine, mulAdd(value.f, weight, sum.f), sum.f);
    sum.pdf = select(mine, mulAdd(value.pdf, weight, sum.pdf), sum.pdf);
    sum.pdfReverse = select(mine, mulAdd(value.pdfReverse, weight, sum.pdfReverse), sum.pdfReverse);
    own = select(mine & (chosen == UInt(k)), value.pdf, own);
    total = total + weight;
  }
  const Real inverse = Real(1) / max(total, Real(1e-30f));
  return {sum.f, sum.pdf * inverse, sum.pdfReverse * inverse};
}

// Lanes in which some part of positive weight has a delta lobe.
template <class P>
WAVECREST_NOINLINE Mask blendHasDelta(const Blend<P>& blend) {
  Mask delta = noLanes();
  for (uint32_t k = 0; k < kMostParts && any(blend.has(k)); ++k) {
    const UInt flags = MaterialLanes(*blend.input.scene, blend.materialOf(k))(blend.input.scene->materials->flags);
    delta = delta | ((blend.weightOf(k) > typename P::Real(0)) & ((flags & UInt(kHasDelta)) == UInt(kHasDelta)));
  }
  return delta;
}

// A sample of blends without their opacity: takes one part by its weight and samples that.
template <class P>
WAVECREST_NOINLINE BsdfSample<typename P::Real> sampleParts(const Blend<P>& blend, const Vec3<typename P::Real>& wi,
                                                            const Uniform4& u) {
  using Real = typename P::Real;
  const Real zero(0);
  const CompoundInput<P>& input = blend.input;
  // Among delta lobes alone only parts that have one.
  const auto pickOf = [&](uint32_t k) WAVECREST_LAMBDA {
    const Real weight = blend.weightOf(k);
    if (input.lobes == Lobes::all) return weight;
    const UInt flags = MaterialLanes(*input.scene, blend.materialOf(k))(input.scene->materials->flags);
    return zeroUnless((flags & UInt(kHasDelta)) == UInt(kHasDelta), weight);
  };
  Real total = zero;
  for (uint32_t k = 0; k < kMostParts && any(blend.has(k)); ++k) total = total + pickOf(k);

  // The part that u.a falls into; what is left of u.a decides within it.
  const Real number = to<Real>(u.a) * total;
  Real before = zero, from = zero, pick = zero;
  UInt chosen(0u), material(0u);
  for (uint32_t k = 0; k < kMostParts && any(blend.has(k)); ++k) {
    const Real weight = pickOf(k);
    const Mask here = (number >= before) & (weight > zero);
    from = select(here, before, from);
    pick = select(here, weight, pick);
    chosen = select(here, UInt(k), chosen);
    material = select(here, blend.materialOf(k), material);
    before = before + weight;
  }
  const Mask taken = blend.lanes & (pick > zero);
  Uniform4 rest = u;
  rest.a = min(max(toFloat((number - from) / max(pick, Real(1e-30f))), Float(0)), Float(0x1.fffffep-1f));
  const Part<P> part(input, material, wi);
  BsdfSample<Real> sample = sampleSingle(part.input, taken, part.turned(wi), rest);
  sample.wo = part.turned(sample.wo);
  sample.weight = zeroUnless(taken, sample.weight);

  // A delta lobe is one of this part's alone.
  const Real share = pick / max(total, Real(1e-30f));
  const Mask delta = sample.specular;
  sample.weight = select(delta, sample.weight * total, sample.weight);
  sample.pdf = select(delta, sample.pdf * share, sample.pdf);
  sample.pdfReverse = select(delta, sample.pdfReverse * share, sample.pdfReverse);
  const Mask finite = andNot(taken, delta);
  if (input.lobes == Lobes::specularOnly || none(finite)) return sample;

  // A direction of another lobe may come from any part, so f and densities are those of the whole blend. The direction
  // counts if the part that was taken did make it.
  Real own;
  const BsdfValue<Real> value = evalParts(blend, wi, sample.wo, chosen, own);
  const Real scale = abs(sample.wo.z) / max(value.pdf, Real(1e-30f));
  const Mask made = (sample.pdf > zero) & (own > zero);
  sample.weight = select(finite, zeroUnless(made, value.f * scale), sample.weight);
  sample.pdf = select(finite, zeroUnless(made, value.pdf), sample.pdf);
  sample.pdfReverse = select(finite, value.pdfReverse, sample.pdfReverse);
  return sample;
}

}  // namespace

template <class P>
BsdfValue<typename P::Real> evalComplete(const CompoundInput<P>& input, Mask active, const Vec3<typename P::Real>& wi,
                                         const Vec3<typename P::Real>& wo) {
  using Real = typename P::Real;
  // The scene may have no compound BSDFs at all, and the block no blends.
  if ((input.kinds & kCompoundKinds) == 0) return evalGeneral<P>(input, active, wi, wo);
  const Mask blends = active & isAmong(input.kind, input.kinds & kBlendKinds);
  if (none(blends)) return evalSingle(input, active, wi, wo);
  Real own;
  // kMostParts is no part: `own` is not used.
  const BsdfValue<Real> blended = evalParts(Blend<P>(input, blends), wi, wo, UInt(kMostParts), own);
  return select(blends, scaled(blended, input.opacity()), evalSingle(input, andNot(active, blends), wi, wo));
}

template <class P>
BsdfSample<typename P::Real> sampleComplete(const CompoundInput<P>& input, Mask active,
                                            const Vec3<typename P::Real>& wi, const Uniform4& u) {
  using Real = typename P::Real;
  if ((input.kinds & kCompoundKinds) == 0) return sampleGeneral<P>(input, active, wi, u);
  const Mask blends = active & isAmong(input.kind, input.kinds & kBlendKinds);
  if (none(blends)) return sampleSingle(input, active, wi, u);
  const Blend<P> blend(input, blends);
  const BsdfSample<Real> blended = sampleWithOpacity(
      input, blends, wi, u, [&]() WAVECREST_LAMBDA { return blendHasDelta(blend); },
      [&](const Uniform4& rest) WAVECREST_LAMBDA { return sampleParts(blend, wi, rest); });
  return select(blends, blended, sampleSingle(input, andNot(active, blends), wi, u));
}

template <class P>
Passage<typename P::Real> passageOf(const SceneView<typename P::Storage>& scene, UInt material, Mask active, Float u,
                                    Float v) {
  using Real = typename P::Real;
  const Real zero(0), one(1);
  const Mask passes = active & passesLight(scene, material);
  Passage<Real> passage{one, {zero, zero, zero}};
  if (none(passes)) return passage;
  Passage<Real> own = passageOfOne<P>(scene, material, u, v);
  if (scene.compounds != nullptr && (scene.bsdfKinds & kBlendKinds) != 0) {
    CompoundInput<P> input(scene, select(passes, material, UInt(0u)));
    input.u = u;
    input.v = v;
    const Mask blends = passes & isAmong(input.kind, kBlendKinds);
    if (any(blends)) {
      // What the blend's own opacity leaves passes, and so does what its parts let through of the rest.
      const Blend<P> blend(input, blends);
      Vec3<Real> through{zero, zero, zero};
      for (uint32_t k = 0; k < kMostParts && any(blend.has(k)); ++k) {
        through = through + blend.passage(k).colour * blend.givenWeight(k);
      }
      own.colour = select(blends, own.colour + through * own.stop, own.colour);
      own.stop = select(blends, own.stop * blend.stopping, own.stop);
    }
  }
  passage.stop = select(passes, own.stop, passage.stop);
  passage.colour = select(passes, own.colour, passage.colour);
  return passage;
}

#define WAVECREST_INSTANTIATE_BSDFS(P)                                                                                 \
  template BsdfValue<P::Real> evalComplete(const CompoundInput<P>&, Mask, const Vec3<P::Real>&, const Vec3<P::Real>&); \
  template BsdfSample<P::Real> sampleComplete(const CompoundInput<P>&, Mask, const Vec3<P::Real>&, const Uniform4&);   \
  template Passage<P::Real> passageOf<P>(const SceneView<P::Storage>&, UInt, Mask, Float, Float);
WAVECREST_INSTANTIATE_BSDFS(FloatPrecision)
WAVECREST_INSTANTIATE_BSDFS(DoublePrecision)
#undef WAVECREST_INSTANTIATE_BSDFS

WAVECREST_SIMD_END
