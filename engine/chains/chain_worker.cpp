#include "engine/chains/chain_worker.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <variant>

#include "engine/tasks/ticks.h"

namespace wavecrest {

template <class S>
StageContext<S> chainContext(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const Pass<S>& pass = plan.pipeline.cameraPass();
  StageContext<S> context{.scene = &plan.view,
                          .sampler = {.kind = SamplerKind::chain, .seed = settings.seed, .iteration = 0},
                          .limits = settings.limits,
                          .mis = misSettings(pass.strategies, plan.mergeRadius, area.pixels.size(), 0),
                          .film = area.window()};
  // A strategy's walks have their lengths; roulette would only lose some.
  if (plan.pipeline.lightPass()) context.limits.rouletteDepth = std::numeric_limits<uint32_t>::max();
  return context;
}

template <class S>
ChainWorker<S>::ChainWorker(const RenderPlan<S>& plan, size_t capacity, SplatFilms& films)
    : pipeline_(plan.pipeline),
      wave_(capacity, plan.needs),
      light_(capacity, plan.needs, plan.lightUse),
      law_(plan.pathLaws.law()),
      needs_(plan.needs),
      splats_(films, plan.stages->addSplats, capacity) {
  lanesArena_ = Arena(lightLanes_.bytes(capacity));
  lightLanes_.bind(lanesArena_, capacity);
  // Make memory for proposed paths, or for ends of walks that are joined.
  if (pipeline_.inPathSpace) {
    paths_.emplace(capacity, law_.maxEdges, plan.needs);
    paths_->law = &law_;
  } else if (pipeline_.lightPass()) {
    ends_.emplace(capacity, plan.needs, wave_);
    light_.reserve(capacity);  // at most one light vertex to a lane: room for all of them from the start
  }
  tallies.resize(stageNames(pipeline_).size());
}

// Lists the lanes whose light walk has something to be joined with. Returns how many there are.
template <class S>
size_t ChainWorker<S>::chooseLightLanes(const Chains& chains, size_t count) {
  size_t chosen = 0;
  for (uint32_t lane = 0; lane < count; ++lane) {
    // A lane stays in the list only if the count moves on.
    lightLanes_[chosen] = lane;
    chosen += chains.lightGranted[lane] != 0 ? 1 : 0;
  }
  // The tail of the last block is read too: lanes that exist, whichever wave was here before.
  std::fill_n(lightLanes_ + chosen, kColumnPadding, 0u);
  return chosen;
}

// A walk of the proposals. The light walk of multiplexed chains begins only in lanes where it can be joined with
// something. Ends of the camera walk that join a light have been joined by then, and are cleared.
template <class S>
void ChainWorker<S>::walkPaths(const Pass<S>& pass, StageContext<S>& context, size_t count, StageTally* tally) {
  const bool light = ends_ && pass.walk == Walk::light;
  if (light) {
    ends_->atOrigin.setVertices(0, 0);
    wave_.pathCount = chooseLightLanes(context.chains.state->columns, count);
    context.lanes.lightPaths = lightLanes_;
  }
  runPass(pass, context, wave_, tally);
  wave_.pathCount = count;
  context.walk = Walk::camera;
  if (light) {
    // Vertices where light walks have ended become light vertices, all of one depth.
    light_.clear();
    light_.beginDepth(ends_->lightAtVertex.rays.size);
    context.light.store = &light_;
  }
}

// Runs the stages of a phase on the wave, or on the ends of walks that the phase names.
template <class S>
void ChainWorker<S>::runOnce(const OnceCalls<S>& calls, StageContext<S>& context, StageTally* tally) {
  Wave<S>* wave = &wave_;
  if (calls.ends != EndsOf::wave) {
    wave = calls.ends == EndsOf::atOrigin         ? &ends_->atOrigin
           : calls.ends == EndsOf::cameraAtVertex ? &ends_->cameraAtVertex
                                                  : &ends_->lightAtVertex;
    context.walk = calls.walk;
    context.depth = calls.depth;
  }
  for (const StageCall<S>& stage : calls.stages) {
    runStage(stage, context, *wave, tally);
    if (tally != nullptr) ++tally;
  }
}

template <class S>
void ChainWorker<S>::trace(StageContext<S> context, ChainState& chains, size_t count, bool measure,
                           PathStore<S>* paths) {
  // Each chain gets one path, made of the chain's random numbers.
  context.chains.state = &chains;
  context.lanes.pixel = chains.columns.proposedPixel;
  // Multiplexed chains make each path by one strategy: emission counts at the vertex where s = 0 ends.
  if (chains.multiplexed) context.lanes.emissionDepth = chains.columns.emissionDepth;
  context.sampler.chain = &chains.samples;
  context.counters = &counters;
  wave_.firstPath = 0;
  wave_.pathCount = count;
  // In path space, the worker holds the proposed paths, which keep parts of the chains' paths.
  if (paths_) {
    assert(paths == nullptr || paths->stride() == paths_->proposed.stride());
    paths_->current = paths;
    context.chains.paths = &*paths_;
    context.lanes.edges = paths_->proposed.headers.edges;
    context.limits.maxDepth = law_.maxEdges + 1;  // arrive lets no path go on at the last vertex
  }
  // No walk has come to its end yet.
  if (ends_) {
    context.chains.ends = &*ends_;
    for (Wave<S>* ends : {&ends_->atOrigin, &ends_->cameraAtVertex, &ends_->lightAtVertex}) {
      ends->pathCount = count;
      ends->setVertices(0, 0);
    }
  }
  // Run phase by phase. Each phase has the next rows of the tallies.
  StageTally* tally = measure ? tallies.data() : nullptr;
  for (const auto& phase : pipeline_.stretches.front().phases) {
    size_t rows = 0;
    if (const auto* const pass = std::get_if<Pass<S>>(&phase)) {
      walkPaths(*pass, context, count, tally);
      rows = pass->stageCount();
    } else {
      const auto& once = std::get<OnceCalls<S>>(phase);
      if (once.decides) break;  // the last phase
      runOnce(once, context, tally);
      rows = once.stages.size();
    }
    if (tally != nullptr) tally += rows;
  }
}

template <class S>
void ChainWorker<S>::decide(StageContext<S> context, ChainState& chains, bool measure) {
  context.chains.state = &chains;
  context.sampler.chain = &chains.samples;
  context.counters = &counters;
  if (paths_) context.chains.paths = &*paths_;
  const OnceCalls<S>& deciding = std::get<OnceCalls<S>>(pipeline_.stretches.front().phases.back());
  // These stages have the last rows of the tallies. Their times include the drain of splats.
  StageTally* tally = measure ? tallies.data() + (tallies.size() - deciding.stages.size()) : nullptr;
  for (const StageCall<S>& stage : deciding.stages) {
    const uint64_t begin = readTicks();
    runStage<S>(stage, context, wave_, nullptr);
    splats_.drain(wave_.splats, counters);
    if (tally == nullptr) continue;
    tally->ticks += readTicks() - begin;
    tally->items += wave_.pathCount;
    tally->laneSlots += (wave_.pathCount + stage.lanes - 1) / stage.lanes * stage.lanes;
    ++tally;
  }
}

template <class S>
void ChainWorker<S>::traceDirect(StageContext<S> context, const FilmArea& area, size_t first, size_t count) {
  const Pass<S>& pass = *pipeline_.directPass;
  // Paths begin in the film's pixels and end after kDirectLength edges.
  context.pixels = area.pixels.data();
  context.limits.maxDepth = std::min(context.limits.maxDepth, kDirectLength);
  // Path tracing needs none of the constants that misSettings adds.
  context.mis = pass.strategies;
  context.counters = &counters;
  wave_.firstPath = first;
  wave_.pathCount = count;
  const uint64_t begin = readTicks();
  runPass<S>(pass, context, wave_, nullptr);
  directTally.ticks += readTicks() - begin;
  directTally.items += count;
}

template <class S>
std::vector<std::string> stageNames(const Pipeline<S>& pipeline) {
  std::vector<std::string> names;
  const auto add = [&](const std::vector<StageCall<S>>& calls) {
    for (const StageCall<S>& call : calls) names.push_back(call.name);
  };
  // The order is that in which trace and decide fill the tallies.
  for (const auto& phase : pipeline.stretches.front().phases) {
    if (const auto* const pass = std::get_if<Pass<S>>(&phase)) {
      names.push_back(pass->generate.name);
      add(pass->firstDepth);
      add(pass->perDepth);
    } else {
      add(std::get<OnceCalls<S>>(phase).stages);
    }
  }
  return names;
}

#define WAVECREST_INSTANTIATE_CHAINS(S)                                                                \
  template StageContext<S> chainContext(const RenderPlan<S>&, const RenderSettings&, const FilmArea&); \
  template class ChainWorker<S>;                                                                       \
  template std::vector<std::string> stageNames(const Pipeline<S>&);
WAVECREST_INSTANTIATE_CHAINS(float)
WAVECREST_INSTANTIATE_CHAINS(double)
#undef WAVECREST_INSTANTIATE_CHAINS

}  // namespace wavecrest
