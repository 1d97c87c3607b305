// acceptMutations: the Metropolis decision, and what it puts on the film.
//
// in: Radiance of the proposals and Chains [pathCount]. out: Chains, moved where accepted; Splats, emptied before.
//
// Both states of a step are splatted by their expected values, contribution over target times (1 - a) and a (Veach
// 1997, 11.5). What is due to the current state is added up and splatted when the chain leaves it, so a step splats
// once.
#include "kernels/columns/chains.h"
#include "kernels/sampling/chain_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

struct Contribution {
  Vec3<Float> colour;  // over its luminance
  Float target;
};

// Contributions that are no finite numbers, and those of negative luminance, count as dark.
template <class S>
WAVECREST_INLINE Contribution proposedContribution(const Wave<S>& wave, const Chains& chains, Mask active, size_t i,
                                                   ChainCounters& counters) {
  const Vec3<Float> value =
      to<Float>(loadVec3(wave.radiance.red, wave.radiance.green, wave.radiance.blue, i)) * load(chains.scale, i);
  const Float luminance = luminanceOf(value);
  const Mask finite = abs(luminance) < Float(1e37f);
  counters.nonFinite += countTrue(andNot(active, finite));
  // Below that the reciprocal is no number either.
  const Mask lit = active & finite & (luminance > Float(1e-37f));
  counters.dark += countTrue(andNot(active & finite, lit));
  const Float inverse = Float(1) / select(lit, luminance, Float(1));
  const auto over = [&](Float x) WAVECREST_LAMBDA { return zeroUnless(lit, x * inverse); };
  return {{over(value.x), over(value.y), over(value.z)}, zeroUnless(lit, luminance)};
}

// Moves the primary samples of accepted lanes, of the vertices that the proposal used. Chains that only ever take large
// steps keep none.
WAVECREST_INLINE void keepSamples(const SamplerSettings& sampler, Mask accepted, UInt vertices, size_t walk, size_t i) {
  const ChainSamples& chain = *sampler.chain;
  if (chain.values == nullptr) return;
  const UInt lane = laneIndex(static_cast<uint32_t>(i));
  for (uint32_t depth = 0;; ++depth) {
    const Mask used = accepted & (UInt(depth) < vertices);
    if (none(used)) return;
    for (uint32_t block = 4 * depth; block < 4 * depth + 4; ++block) {
      if (!chain.keeps(walk, block)) continue;
      const ChainNumbers numbers = chainNumbers(sampler, lane, block, walk == 1 ? Stream::light : Stream::camera);
      uint32_t* row = chain.values + size_t{4} * chain.column(walk, block) * chain.stride + i;
      for (const UInt number : {numbers.a, numbers.b, numbers.c, numbers.d}) {
        store(select(used, number, load(row)), row);
        row += chain.stride;
      }
    }
  }
}

// Kinds that no lane has proposed cost nothing but the question.
WAVECREST_INLINE void countSteps(ChainCounters& counters, Mask active, UInt kind, Mask accepted) {
  for (uint32_t k = 0; k < kMutationKinds; ++k) {
    const Mask mine = active & (kind == UInt(k));
    if (none(mine)) continue;
    counters.proposed[k] += countTrue(mine);
    counters.accepted[k] += countTrue(accepted & mine);
  }
}

// What kind of step a chain takes: in primary samples large where nothing is perturbed.
template <class S>
WAVECREST_INLINE UInt kindOf(const StageContext<S>& context, size_t i) {
  if (context.chains.paths != nullptr) return load(context.chains.paths->plans.kind, i);
  const Mask large = load(context.chains.state->columns.cameraLive, i) == UInt(0u);
  return select(large, UInt(static_cast<uint32_t>(Mutation::large)), UInt(static_cast<uint32_t>(Mutation::small)));
}

WAVECREST_INLINE void countRejections(ChainState& state, Mask active, Mask accepted, size_t i) {
  const UInt run = select(accepted, UInt(0u), load(state.columns.rejections, i) + UInt(1u));
  store(run, state.columns.rejections, i);
  HWY_ALIGN uint32_t runs[kLanes];
  store(select(active, run, UInt(0u)), runs);
  for (const uint32_t length : runs) {
    if (length > state.counters.longestRejection) state.counters.longestRejection = length;
    if (length == kStuckRejections) ++state.counters.stuck;
  }
}

// What the large steps of a block say about b.
WAVECREST_INLINE void addEstimates(ChainState& state, Mask large, Float estimate, size_t i) {
  HWY_ALIGN float values[kLanes];
  HWY_ALIGN uint32_t lengths[kLanes];
  store(compress(estimate, large), values);
  store(compress(load(state.columns.length, i), large), lengths);
  for (size_t k = 0, count = countTrue(large); k < count; ++k) {
    state.largeSteps.add(lengths[k], static_cast<double>(values[k]));
  }
}

}  // namespace

template <class P>
void acceptMutations(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  ChainState& state = *context.chains.state;
  const Chains& chains = state.columns;
  const size_t count = wave.pathCount;
  wave.splats.size = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const Contribution proposed = proposedContribution(wave, chains, active, i, state.counters);
    const Vec3<Float> colour = loadVec3(chains.red, chains.green, chains.blue, i);
    const Float target = load(chains.target, i), weight = load(chains.weight, i);

    // a = min(1, I(y) / I(x)); from nowhere any light is taken.
    const Float one(1);
    const Mask somewhere = target > Float(0);
    const Float ratio = min(proposed.target / select(somewhere, target, one), one);
    const Float a = select(somewhere, ratio, zeroUnless(proposed.target > Float(0), one));
    const Mask accepted = active & (load(chains.threshold, i) < a);
    const UInt kind = kindOf(context, i);
    countSteps(state.counters, active, kind, accepted);
    const Mask large = active & (kind == UInt(static_cast<uint32_t>(Mutation::large)));
    if (any(large)) {
      addEstimates(state, large, context.chains.paths != nullptr ? load(chains.estimate, i) : proposed.target, i);
    }
    countRejections(state, active, accepted, i);

    // The state that is left goes to the film with all its visits, else the proposal with its share.
    const UInt pixel = load(chains.pixel, i), proposedPixel = load(chains.proposedPixel, i);
    const Float due = zeroUnless(somewhere, weight + (one - a));
    const Float visits = select(accepted, due, a);
    const Vec3<Float> splat = select(accepted, colour, proposed.colour) * (visits * Float(state.splatFactor));
    const Mask splats = active & (visits > Float(0)) & (maxComponent(splat) > Float(0));
    pushSplats(wave.splats, select(accepted, pixel, proposedPixel), splats,
               Vec3<Real>{to<Real>(splat.x), to<Real>(splat.y), to<Real>(splat.z)});

    store(select(accepted, a, due), chains.weight, i);
    if (none(accepted)) continue;
    storeVec3(select(accepted, proposed.colour, colour), chains.red, chains.green, chains.blue, i);
    store(select(accepted, proposed.target, target), chains.target, i);
    store(select(accepted, proposedPixel, pixel), chains.pixel, i);
    const UInt camera = load(chains.proposedCamera, i), light = load(chains.proposedLight, i);
    keepSamples(context.sampler, accepted, camera, 0, i);
    keepSamples(context.sampler, accepted, light, 1, i);
    // Last: until here the proposals are functions of what the chains were.
    store(select(accepted, camera, load(chains.cameraVertices, i)), chains.cameraVertices, i);
    store(select(accepted, light, load(chains.lightVertices, i)), chains.lightVertices, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(acceptMutations)
