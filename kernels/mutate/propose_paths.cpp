// proposePaths: decides by which mutation each chain changes its path, and what of the path that replaces
// (METHODS 7.6).
//
// in: Chains [pathCount] (source, length), the current paths; the sampler's iteration is the step. out: the proposals'
// plans and their lanes sorted by mutation; the rows that the proposals keep, copied; Chains::threshold and what the
// sampler and arrive ask about a chain. A chain without a path, and every chain of a bootstrap, makes one anew, of the
// length that the engine wants.
#include "kernels/mutate/path_lanes.h"
#include "kernels/mutate/path_law_lanes.h"
#include "kernels/sampling/chain_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

struct Plan {
  UInt kind, lightKept, eyeFrom, added, lightWalked;
  Mask possible;
};

WAVECREST_INLINE Plan select(Mask m, const Plan& yes, const Plan& no) {
  return {select(m, yes.kind, no.kind),
          select(m, yes.lightKept, no.lightKept),
          select(m, yes.eyeFrom, no.eyeFrom),
          select(m, yes.added, no.added),
          select(m, yes.lightWalked, no.lightWalked),
          (m & yes.possible) | andNot(no.possible, m)};
}

// One of `count` with equal chances.
WAVECREST_INLINE UInt choose(Float u, UInt count) { return min(toUInt(u * toFloat(count)), count - UInt(1u)); }

// A path made anew: its length by the law, or as given; a split of its k + 1 vertices, of which the lens is no light
// vertex. A path of one edge is a light that is met by chance.
WAVECREST_INLINE Plan anew(const PathLaw& law, UInt edges, UInt length, UInt random, Float split) {
  const UInt zero(0u), one(1u);
  UInt drawn(law.minEdges);
  const Float u = toUnitInterval(random);
  for (uint32_t k = law.minEdges; k < law.maxEdges; ++k) {
    drawn = select(u < Float(law.lengthsUpTo[k]), drawn, UInt(k + 1));
  }
  const UInt k = select(length == zero, drawn, length);
  const UInt walked = choose(split, k + one);
  return {mutationCode(Mutation::large), zero, edges + one, k + one, select(k == one, zero, walked), allLanes()};
}

WAVECREST_INLINE Plan bidirectional(const PathLaw& law, UInt edges, const ChainNumbers& bits) {
  const UInt zero(0u), one(1u);
  const Mask enough = one < edges;
  const UInt k = select(enough, edges, UInt(2u));
  const UInt first = gather(law.firstDeletion, k), count = gather(law.firstDeletion + 1, k) - first;
  const UInt drawn = first + choose(toUnitInterval(bits.a), count);
  const RecordLanes<AliasEntry> entry(law.deletions, drawn);
  const UInt chosen =
      select(toUnitInterval(bits.b) < entry(law.deletions->keep), drawn, first + entry(law.deletions->other));
  const UInt range = gather(law.ranges, chosen);
  const UInt lightKept = range & UInt(0xffffu), eyeFrom = shiftRight<16>(range);
  const Mask newLens = eyeFrom == k + one;
  const UInt deleted = eyeFrom - lightKept;
  const AddedRange range2 = addedRange(law, k, lightKept, eyeFrom);
  // Walks up the law until the number is used up.
  const Float wanted = toUnitInterval(bits.c) * range2.sum;
  Float below(0);
  UInt index(0u);
  Mask found = noLanes();
  for (uint32_t i = 0; i < kAddedLaw.size(); ++i) {
    const Mask allowed = (range2.first < UInt(i + 1)) & (UInt(i) < range2.end);
    below = select(allowed, below + Float(kAddedLaw[i]), below);
    const Mask here = andNot(allowed, found);  // the last allowed one, should rounding leave none
    index = select(here, UInt(i), index);
    found = found | (allowed & (wanted < below));
  }
  const UInt added = deleted + index - UInt(static_cast<uint32_t>(kMostAdded));
  const UInt splits = splitsOf(added, newLens, edges - deleted + added);
  const Mask possible = enough & (range2.first < range2.end);
  const UInt walked = choose(toUnitInterval(bits.d), max(splits, one));
  return {mutationCode(Mutation::bidirectional), lightKept, eyeFrom, select(possible, added, zero),
          select(possible, walked, zero),        possible};
}

// Copies the rows that proposals keep to where they have them.
template <class S>
WAVECREST_INLINE void keepRows(PathMutations<S>& paths, size_t count) {
  const PathPlans& plans = paths.plans;
  const size_t stride = paths.proposed.stride();
  for (size_t i = 0; i < count; i += kLanes) {
    const UInt lane = laneIndex(static_cast<uint32_t>(i));
    const UInt kept = load(plans.lightKept, i), from = load(plans.eyeFrom, i), to = load(plans.eyeTo, i);
    const UInt edges = load(paths.current->headers.edges, i), length = load(paths.proposed.headers.edges, i);
    const UInt zero(0u);
    for (uint32_t row = 0;; ++row) {
      const UInt r(row);
      const Mask left = length < r;
      if (all(left)) break;
      const Mask upper = !(r < to);
      const Mask keeps = andNot((r < kept) | upper, left);
      if (none(keeps)) continue;
      const UInt source = select(keeps, select(upper, r + from - to, r), zero);
      const UInt at = min(source, edges) * UInt(static_cast<uint32_t>(stride)) + lane;
      forEachColumn(paths.current->vertices, paths.proposed.vertices,
                    [&](const auto& in, const auto& out)
                        WAVECREST_LAMBDA { store(gather(in, at), out, row * stride + i); });
    }
  }
}

// Lanes by their mutation, in order: walks of the same kind run side by side.
WAVECREST_INLINE void sortByKind(const PathPlans& plans, size_t count) {
  size_t first[kMutationKinds + 1] = {};
  for (size_t i = 0; i < count; ++i) ++first[plans.kind[i] + 1];
  for (size_t kind = 0; kind < kMutationKinds; ++kind) first[kind + 1] += first[kind];
  for (size_t i = 0; i < count; ++i) plans.order[first[plans.kind[i]]++] = static_cast<uint32_t>(i);
}

// The plans of block i, for a path of so many edges, go into the columns; walks have reached nothing yet.
template <class S>
WAVECREST_INLINE void storePlan(const Plan& plan, UInt edges, const PathMutations<S>& paths, const Chains& chains,
                                size_t i) {
  const UInt zero(0u), one(1u);
  // How many rays each walk needs: one fewer where it begins with a new end of the path.
  const Mask newLens = plan.eyeFrom == edges + one;
  const UInt eyeWalked = plan.added - plan.lightWalked;
  const UInt lightRays = select(plan.lightKept == zero, max(plan.lightWalked, one) - one, plan.lightWalked);
  const UInt eyeRays = select(newLens, eyeWalked - one, eyeWalked);
  const UInt length = select(plan.possible, edges + one - plan.eyeFrom + plan.lightKept + plan.added - one, zero);
  store(plan.kind, paths.plans.kind, i);
  store(plan.lightKept, paths.plans.lightKept, i);
  store(plan.eyeFrom, paths.plans.eyeFrom, i);
  store(plan.lightKept + plan.added, paths.plans.eyeTo, i);
  store(plan.lightWalked, paths.plans.lightWalked, i);
  store(select(plan.possible, lightRays, zero), paths.plans.lightRays, i);
  store(select(plan.possible, eyeRays, zero), paths.plans.eyeRays, i);
  store(zero, paths.plans.lightReached, i);
  store(zero, paths.plans.eyeReached, i);
  store(zero, paths.plans.lightEvent, i);
  store(zero, paths.plans.eyeEvent, i);
  store(length, paths.proposed.headers.edges, i);
  // Fresh numbers for every walk; emission counts where a walk from the lens is to meet the light.
  store(zero, chains.cameraLive, i);
  store(zero, chains.lightLive, i);
  const Mask byChance = plan.possible & (plan.lightKept == zero) & (plan.lightWalked == zero);
  store(select(byChance, eyeRays, zero), chains.emissionDepth, i);
  store(Float(1), chains.scale, i);
  store(Float(0), chains.estimate, i);
}

// The same for every feature set, so there is one for each storage type.
template <class S>
WAVECREST_NOINLINE void proposeWave(const StageContext<S>& context, const Wave<S>& wave) {
  const Chains& chains = context.chains.state->columns;
  PathMutations<S>& paths = *context.chains.paths;
  const PathLaw& law = *paths.law;
  const PathPlans& plans = paths.plans;
  const auto& proposed = paths.proposed.headers;
  const size_t count = wave.pathCount;
  const UInt zero(0u), one(1u);
  for (size_t i = 0; i < count; i += kLanes) {
    const UInt source = load(chains.source, i);
    // Random numbers of the step: its kind, its acceptance threshold, and what the mutation chooses.
    const ChainNumbers step = chainBits(context.sampler, source, 0, ChainUse::step);
    const ChainNumbers more = chainBits(context.sampler, source, 1, ChainUse::step);
    store(thresholdOf(step.b, step.c), chains.threshold, i);
    const UInt edges = paths.current == nullptr ? zero : load(paths.current->headers.edges, i);
    const Mask large = (toUnitInterval(step.a) < Float(context.chains.state->samples.largeStep)) | (edges == zero);

    // Large steps, and chains that are nowhere yet, plan a whole path.
    Plan plan = anew(law, edges, load(chains.length, i), more.a, toUnitInterval(more.d));
    if (paths.current != nullptr && !all(large)) {
      // Small steps choose evenly among the mutations that suit the current path.
      const auto& current = paths.current->headers;
      const UInt eyeEnd = load(current.eyeEnd, i), causticStart = load(current.causticStart, i);
      const Mask multiChain = load(current.multiChain, i) != zero;
      const Plan fromEye{select(multiChain, mutationCode(Mutation::multiChain), mutationCode(Mutation::lens)),
                         eyeEnd,
                         edges + one,
                         edges + one - eyeEnd,
                         zero,
                         allLanes()};
      const UInt rest = edges - causticStart;
      const Plan caustic{mutationCode(Mutation::caustic), causticStart, edges + one, rest + one, rest, allLanes()};
      const SuitableKinds kinds = suitableKinds(law, edges, causticStart);
      const UInt chosen = choose(toUnitInterval(step.d), max(kinds.count, one));
      const Mask eye = chosen < kinds.fromEye;
      const Mask replaces = andNot(chosen < kinds.fromEye + kinds.bidirectional, eye);
      plan = select(large, plan, fromEye);
      if (any(andNot(replaces, large))) plan = select(andNot(replaces, large), bidirectional(law, edges, more), plan);
      plan = select(andNot(!(eye | replaces), large), caustic, plan);
      plan.possible = plan.possible & (large | !(kinds.count == zero));
    }

    storePlan(plan, edges, paths, chains, i);
    if (paths.current != nullptr) {
      // What the proposal keeps unless its walks replace it: the film position and the light's radiance.
      const auto& current = paths.current->headers;
      store(load(current.rasterX, i), proposed.rasterX, i);
      store(load(current.rasterY, i), proposed.rasterY, i);
      store(load(current.lightR, i), proposed.lightR, i);
      store(load(current.lightG, i), proposed.lightG, i);
      store(load(current.lightB, i), proposed.lightB, i);
    }
  }
  sortByKind(plans, count);
  if (paths.current != nullptr) keepRows(paths, count);
}

}  // namespace

template <class P>
void proposePaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  proposeWave(context, wave);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(proposePaths)
