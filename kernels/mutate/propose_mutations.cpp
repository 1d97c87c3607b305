// proposeMutations: decides what kind of step each chain takes, and, of multiplexed chains, by which strategy.
//
// in: Chains [pathCount] (state, source, length); the sampler's iteration is the step. out: the columns of the
// proposal, as far as they are known before the walks. METHODS 7.2: a large step draws every number afresh, a small one
// moves those that the current path used.
#include "kernels/columns/chains.h"
#include "kernels/sampling/chain_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// (s, t) of a path of `length` edges: s = 0 to length by one primary sample, t = length + 1 - s. A path of one edge is
// an emitter in view, which nothing but s = 0 makes. Both walks then have one vertex less than s and t, as edges.
template <class S>
WAVECREST_INLINE void chooseStrategy(const StageContext<S>& context, UInt lane, size_t i) {
  const Chains& chains = context.chains.state->columns;
  const UInt length = load(chains.length, i);
  const UInt zero(0u), one(1u);
  const UInt strategies = select(length == one, one, length + one);
  const Uniform4 u = uniform4(context.sampler, lane, static_cast<uint32_t>(Block::opacity), Stream::camera);
  const UInt s = min(toUInt(u.a * toFloat(strategies)), strategies - one);
  const UInt cameraEdges = length - s;
  const Mask lens = cameraEdges == zero;
  // t = 1 has one path for all pixels together, the others one for each.
  const double pixels = static_cast<double>(context.film.width) * context.film.height;
  const Float perPixel = select(lens, Float(1 / pixels), Float(1));
  const UInt lightEdges = max(s, one) - one;
  store(toFloat(strategies) * perPixel, chains.scale, i);
  store(cameraEdges, chains.cameraEdges, i);
  store(lightEdges, chains.lightEdges, i);
  store(select(lens, lightEdges, zero), chains.lightGranted, i);
  store(select(s == zero, length, zero), chains.emissionDepth, i);
  store(max(cameraEdges, one), chains.proposedCamera, i);
  store(lightEdges, chains.proposedLight, i);
}

}  // namespace

template <class P>
void proposeMutations(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const ChainState& state = *context.chains.state;
  const Chains& chains = state.columns;
  const size_t count = wave.pathCount;
  for (size_t i = 0; i < count; i += kLanes) {
    const UInt lane = laneIndex(static_cast<uint32_t>(i));
    const ChainNumbers u = chainBits(context.sampler, load(chains.source, i), 0, ChainUse::step);
    const Mask large = toUnitInterval(u.a) < Float(state.samples.largeStep);
    const UInt none(0u);
    store(select(large, none, load(chains.cameraVertices, i)), chains.cameraLive, i);
    store(select(large, none, load(chains.lightVertices, i)), chains.lightLive, i);
    // 48 bits: the grid of 2^-24 alone would let through a targets' ratio of any smallness once in 2^24 steps.
    store(thresholdOf(u.b, u.c), chains.threshold, i);
    if (state.multiplexed) {
      chooseStrategy(context, lane, i);
    } else {
      store(Float(1), chains.scale, i);
      store(UInt(1u), chains.proposedCamera, i);
      store(none, chains.proposedLight, i);
    }
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(proposeMutations)
