#include "engine/chains/chain_worker.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace wavecrest {
namespace {

constexpr uint32_t bit(Block block) { return 1u << static_cast<uint32_t>(block); }

// Every stage of the step: propose, the camera pass, its joins, the light pass, its joins, accept.
template <class S, class Function>
void forEachStage(const Pipeline<S>& pipeline, Function&& function) {
  const auto pass = [&](const Pass<S>& p) {
    function(p.generate);
    for (const StageCall<S>& stage : p.firstDepth) function(stage);
    for (const StageCall<S>& stage : p.perDepth) function(stage);
  };
  const ChainCalls<S>& chains = *pipeline.chains;
  function(chains.propose);
  pass(pipeline.cameraPass);
  for (const JoinCall<S>& join : chains.afterCamera) function(join.stage);
  if (pipeline.lightPass) pass(*pipeline.lightPass);
  for (const JoinCall<S>& join : chains.afterLight) function(join.stage);
  for (const StageCall<S>& stage : chains.weigh) function(stage);
  function(chains.accept);
  for (const StageCall<S>& stage : chains.commit) function(stage);
}

}  // namespace

template <class S>
ChainState::Kept keptSamples(const Pipeline<S>& pipeline, const SceneView<S>& scene, uint32_t maxDepth) {
  const uint32_t sky = scene.environment.width != 0 ? bit(Block::environment) : 0u;
  ChainState::Kept kept;
  if (pipeline.chains->inPathSpace()) {  // numbers are drawn for all that walks do, and none is kept
    kept.blocks[0] = kept.blocks[1] = {0xfu, 0xfu};
    return kept;
  }
  if (!pipeline.lightPass) {
    kept.blocks[0] = {bit(Block::scatter), bit(Block::scatter) | bit(Block::light) | sky};
    kept.vertices[0] = maxDepth;  // the last vertex, which draws nothing, does not count
    return kept;
  }
  // One next event at most, whose numbers are those of vertex 0 whatever the path's length.
  kept.blocks[0] = {bit(Block::scatter) | bit(Block::light) | bit(Block::opacity) | sky, bit(Block::scatter)};
  kept.blocks[1] = {bit(Block::scatter) | bit(Block::light) | sky, bit(Block::scatter)};
  kept.vertices[0] = kept.vertices[1] = maxDepth;
  return kept;
}

template <class S>
StageContext<S> chainContext(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const Pass<S>& pass = plan.pipeline.cameraPass;
  StageContext<S> context{.scene = &plan.scene->view,
                          .sampler = {.kind = SamplerKind::chain, .seed = settings.seed, .iteration = 0},
                          .limits = settings.limits,
                          .mis = misSettings(pass.strategies, settings, plan.scene->view.radius, area.pixels.size(), 0),
                          .splats = {nullptr, area.x0, area.y0, area.width, area.height}};
  // A strategy's walks have their lengths; roulette would only lose some.
  if (plan.pipeline.lightPass) context.limits.rouletteDepth = std::numeric_limits<uint32_t>::max();
  return context;
}

template <class S>
ChainWorker<S>::ChainWorker(const RenderPlan<S>& plan, size_t capacity, size_t pixels)
    : splats(3 * pixels),
      pipeline_(plan.pipeline),
      wave_(capacity, plan.needs),
      light_(capacity, plan.needs, plan.lightUse),
      law_(plan.pathLaws.law()),
      needs_(plan.needs) {
  lanesArena_ = Arena(lightLanes_.bytes(capacity));
  lightLanes_.bind(lanesArena_, capacity);
  if (pipeline_.chains->inPathSpace()) {
    paths_.emplace(capacity, law_.maxEdges, plan.needs);
    paths_->law = &law_;
  } else if (pipeline_.lightPass) {
    ends_.emplace(capacity, plan.needs, wave_);
    light_.reserve(capacity);  // at most one light vertex to a lane: room for all of them from the start
  }
  tallies.resize(stageNames(pipeline_).size());
}

template <class S>
void ChainWorker<S>::join(const std::vector<JoinCall<S>>& joins, StageContext<S>& context, StageTally* tally) {
  for (const JoinCall<S>& call : joins) {
    Wave<S>& wave = call.ends == EndsOf::atOrigin         ? ends_->atOrigin
                    : call.ends == EndsOf::cameraAtVertex ? ends_->cameraAtVertex
                                                          : ends_->lightAtVertex;
    context.walk = call.walk;
    context.depth = call.depth;
    runStage(call.stage, context, wave, tally);
    if (tally != nullptr) ++tally;
  }
}

template <class S>
size_t ChainWorker<S>::chooseLightLanes(const Chains& chains, size_t count) {
  size_t chosen = 0;
  for (uint32_t lane = 0; lane < count; ++lane) {
    lightLanes_[chosen] = lane;
    chosen += chains.lightGranted[lane] != 0 ? 1 : 0;
  }
  // The tail of the last block is read too: lanes that exist, whichever wave was here before.
  std::fill_n(lightLanes_ + chosen, kColumnPadding, 0u);
  return chosen;
}

template <class S>
void ChainWorker<S>::tracePaths(StageContext<S>& context, size_t count, StageTally* tally) {
  const auto next = [&tally](size_t stages) {
    StageTally* const mine = tally;
    tally = tally == nullptr ? nullptr : tally + stages;
    return mine;
  };
  context.limits.maxDepth = law_.maxEdges + 1;  // arrive lets no path go on at the last vertex
  runStage(pipeline_.chains->propose, context, wave_, next(1));
  runPass(pipeline_.cameraPass, context, wave_, next(pipeline_.cameraPass.stageCount()));
  wave_.pathCount = count;
  runPass(*pipeline_.lightPass, context, wave_, next(pipeline_.lightPass->stageCount()));
  context.walk = Walk::camera;
  for (const StageCall<S>& stage : pipeline_.chains->weigh) runStage(stage, context, wave_, next(1));
}

template <class S>
void ChainWorker<S>::trace(StageContext<S> context, ChainState& chains, size_t count, bool measure,
                           PathStore<S>* paths) {
  StageTally* tally = measure ? tallies.data() : nullptr;
  const auto advance = [&tally](size_t stages) { tally = tally == nullptr ? nullptr : tally + stages; };
  context.chains = &chains;
  context.sampler.chain = &chains.samples;
  context.counters = &counters;
  context.splats.sums = nullptr;  // contributions go to the chain's lane
  wave_.firstPath = 0;
  wave_.pathCount = count;
  if (paths_) {
    assert(paths == nullptr || paths->stride() == paths_->proposed.stride());
    paths_->current = paths;
    context.paths = &*paths_;
    tracePaths(context, count, tally);
    return;
  }
  runStage(pipeline_.chains->propose, context, wave_, tally);
  advance(1);
  if (ends_) {
    context.ends = &*ends_;
    for (Wave<S>* ends : {&ends_->atOrigin, &ends_->cameraAtVertex, &ends_->lightAtVertex}) {
      ends->pathCount = count;
      ends->setVertices(0, 0);
    }
  }
  runPass(pipeline_.cameraPass, context, wave_, tally);
  advance(pipeline_.cameraPass.stageCount());
  if (!pipeline_.lightPass) return;

  join(pipeline_.chains->afterCamera, context, tally);
  advance(pipeline_.chains->afterCamera.size());
  ends_->atOrigin.setVertices(0, 0);
  wave_.pathCount = chooseLightLanes(chains.columns, count);
  context.lanes = lightLanes_;
  runPass(*pipeline_.lightPass, context, wave_, tally);
  advance(pipeline_.lightPass->stageCount());
  wave_.pathCount = count;

  light_.clear();
  light_.beginDepth(ends_->lightAtVertex.rays.size);
  context.light = &light_;
  join(pipeline_.chains->afterLight, context, tally);
}

template <class S>
void ChainWorker<S>::decide(StageContext<S> context, ChainState& chains, bool measure) {
  context.chains = &chains;
  context.sampler.chain = &chains.samples;
  context.counters = &counters;
  context.splats.sums = splats.data();
  if (paths_) context.paths = &*paths_;
  const std::vector<StageCall<S>>& commit = pipeline_.chains->commit;
  StageTally* tally = measure ? tallies.data() + (tallies.size() - 1 - commit.size()) : nullptr;
  runStage(pipeline_.chains->accept, context, wave_, tally);
  for (const StageCall<S>& stage : commit) runStage(stage, context, wave_, tally == nullptr ? nullptr : ++tally);
}

template <class S>
void ChainWorker<S>::traceDirect(StageContext<S> context, const FilmArea& area, size_t first, size_t count) {
  const Pass<S>& pass = *pipeline_.chains->directPass;
  context.pixels = area.pixels.data();
  context.limits.maxDepth = std::min(context.limits.maxDepth, kDirectLength);
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
  forEachStage(pipeline, [&](const StageCall<S>& stage) { names.emplace_back(stage.name); });
  return names;
}

#define WAVECREST_INSTANTIATE_CHAINS(S)                                                                \
  template ChainState::Kept keptSamples(const Pipeline<S>&, const SceneView<S>&, uint32_t);            \
  template StageContext<S> chainContext(const RenderPlan<S>&, const RenderSettings&, const FilmArea&); \
  template class ChainWorker<S>;                                                                       \
  template std::vector<std::string> stageNames(const Pipeline<S>&);
WAVECREST_INSTANTIATE_CHAINS(float)
WAVECREST_INSTANTIATE_CHAINS(double)
#undef WAVECREST_INSTANTIATE_CHAINS

}  // namespace wavecrest
