#include "engine/plan/pipeline.h"

#include <x86intrin.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "engine/plan/stage_contracts.h"
#include "engine/plan/stage_observer.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

uint64_t readTicks() { return __rdtsc(); }

namespace {

// The two clocks at the same moment: of several readings the one that was disturbed least.
struct Moment {
  std::chrono::steady_clock::time_point time;
  uint64_t ticks = 0;
};
Moment readBothClocks() {
  using Clock = std::chrono::steady_clock;
  Moment best;
  Clock::duration least = Clock::duration::max();
  for (int attempt = 0; attempt < 16; ++attempt) {
    const auto before = Clock::now();
    const uint64_t ticks = readTicks();
    const Clock::duration taken = Clock::now() - before;
    if (taken < least) {
      least = taken;
      best = {before + taken / 2, ticks};
    }
  }
  return best;
}

}  // namespace

double secondsPerTick() {
  // Measured once for the process, over 20 ms.
  static const double value = [] {
    const Moment begin = readBothClocks();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Moment end = readBothClocks();
    return std::chrono::duration<double>(end.time - begin.time).count() / static_cast<double>(end.ticks - begin.ticks);
  }();
  return value;
}

// ---- from page to calls ---------------------------------------------------------------------------------------------

namespace {

// How many records of the wave a stage of this kind is about to read.
template <class S>
size_t itemsOf(const Wave<S>& wave, StageItems items) {
  switch (items) {
    case StageItems::beginning:
      return wave.pathCount;
    case StageItems::live:
      return wave.rays.size;
    case StageItems::joinable:
      return wave.joinable;
    case StageItems::shadowRays:
      return wave.shadowRays.size;
  }
  return 0;
}

// Turns the steps and phases of a page into calls of compiled kernels.
template <class S>
class Caller {
 public:
  Caller(const MethodPage& page, const Stages<S>& stages, const Intersector<S>& intersector)
      : page_(page), stages_(stages), intersector_(intersector) {}

  // The call of one stage. first: the step is of the list for depth 1. before: the stage in front of it, or the stage
  // itself if there is none. The name of the row depends on both.
  StageCall<S> call(Walk walk, bool first, Step step, StageId before) const {
    const StageInfo& info = infoOf(step.stage);
    StageCall<S> call{rowName(page_, walk, first, step.stage, before),
                      nullptr,
                      items(info.items),
                      info.single ? 1 : stages_.lanes,
                      step.repeat,
                      step.repeat == Repeat::untilJoined && info.items != StageItems::shadowRays};
    // The scene decides which kernels stand for extend and occlude.
    if (step.stage == StageId::extend || step.stage == StageId::occlude) {
      call.run = step.stage == StageId::extend ? intersector_.extend : intersector_.occlude;
      call.lanes = intersector_.lanes;
    } else {
      call.run = stages_.of(step.stage);
    }
    return call;
  }
  template <class List>
  std::vector<StageCall<S>> calls(Walk walk, bool first, const List& steps) const {
    std::vector<StageCall<S>> calls;
    StageId before{};
    for (const Step step : steps) {
      calls.push_back(call(walk, first, step, calls.empty() ? step.stage : before));
      before = step.stage;
    }
    return calls;
  }
  std::vector<StageCall<S>> calls(const OncePhase& phase) const {
    std::vector<Step> steps;
    for (const StageId stage : phase.stages) steps.push_back({stage});
    return calls(phase.walk, false, steps);
  }
  // The pass of a walk. Only connections to the camera make splats.
  Pass<S> pass(const WalkPhase& walk) const {
    return {.walk = walk.walk,
            .strategies = weightsOf(page_, walk.walk),
            .generate = call(walk.walk, false, {walk.generate}, walk.generate),
            .firstDepth = calls(walk.walk, true, walk.first),
            .perDepth = calls(walk.walk, false, walk.steps),
            .splats = walk.steps.has(StageId::connectToCamera)};
  }

 private:
  // StageCall::items is a plain function pointer, so each kind of item has its own function.
  static size_t (*items(StageItems kind))(const Wave<S>&) {
    switch (kind) {
      case StageItems::beginning:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::beginning); };
      case StageItems::live:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::live); };
      case StageItems::joinable:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::joinable); };
      case StageItems::shadowRays:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::shadowRays); };
    }
    return nullptr;
  }

  const MethodPage& page_;
  const Stages<S>& stages_;
  const Intersector<S>& intersector_;
};

// The phases of a method with chains. The phase that begins with acceptMutations decides, all others trace.
template <class S>
ChainCalls<S> chainCalls(const MethodPage& page, const Caller<S>& caller) {
  ChainCalls<S> chains;
  chains.inPathSpace = page.has(StageId::proposePaths);
  for (const Phase& phase : page.phases) {
    if (const auto* walking = std::get_if<WalkPhase>(&phase)) {
      chains.trace.push_back(walking->walk);
    } else if (const auto* once = std::get_if<OncePhase>(&phase)) {
      std::vector<StageCall<S>> calls = caller.calls(*once);
      if (once->stages.front() == StageId::acceptMutations) {
        chains.decide = std::move(calls);
      } else {
        chains.trace.push_back(OnceCalls<S>{std::move(calls), once->ends, once->walk, once->depth});
      }
    }
  }
  return chains;
}

}  // namespace

template <class S>
bool ChainCalls<S>::joinsEnds() const {
  return std::any_of(trace.begin(), trace.end(), [](const auto& phase) {
    const auto* once = std::get_if<OnceCalls<S>>(&phase);
    return once != nullptr && once->ends != EndsOf::wave;
  });
}

template <class S>
Pipeline<S> makePipeline(const MethodPage& page, const Stages<S>& stages, const Intersector<S>& intersector) {
  const Caller<S> caller(page, stages, intersector);
  Pipeline<S> pipeline;
  pipeline.photonMap = page.hasPhotonMap();
  pipeline.cameraPass = caller.pass(*page.walk(Walk::camera));
  if (const WalkPhase* light = page.walk(Walk::light)) pipeline.lightPass = caller.pass(*light);
  if (page.hasChains()) {
    pipeline.chains = chainCalls(page, caller);
    if (!page.directLight.empty()) {
      // Direct light is a page of its own: chains change neither the weights nor the names of its stages.
      const MethodPage direct{{page.directLight.front()}};
      pipeline.chains->directPass = Caller<S>(direct, stages, intersector).pass(page.directLight.front());
    }
  }
  return pipeline;
}
template struct ChainCalls<float>;
template struct ChainCalls<double>;
template Pipeline<float> makePipeline(const MethodPage&, const Stages<float>&, const Intersector<float>&);
template Pipeline<double> makePipeline(const MethodPage&, const Stages<double>&, const Intersector<double>&);

// ---- running --------------------------------------------------------------------------------------------------------

namespace {

// Runs a stage. Adds items, lanes and ticks to the tally, if there is one.
template <class S>
void timeStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  if (tally == nullptr) {
    stage.run(context, wave);
    return;
  }
  // Items are counted first, because the stage changes the sizes of the queues.
  const size_t items = stage.countedOnce && context.repetition != 0 ? 0 : stage.items(wave);
  tally->items += items;
  tally->laneSlots += (items + stage.lanes - 1) / stage.lanes * stage.lanes;
  // The observer's own time stays outside of the measured ticks.
  StageObserver* const observer = stageObserver.load(std::memory_order_relaxed);
  if (observer != nullptr) observer->begin();
  const uint64_t begin = readTicks();
  stage.run(context, wave);
  tally->ticks += readTicks() - begin;
  if (observer != nullptr) observer->end(stage.name);
}

}  // namespace

template <class S>
void runStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  if constexpr (kChecksContracts) requireBefore(stage.name, context, wave);
  timeStage(stage, context, wave, tally);
  if constexpr (kChecksContracts) requireAfter(stage.name, context, wave);
}
template void runStage(const StageCall<float>&, const StageContext<float>&, Wave<float>&, StageTally*);
template void runStage(const StageCall<double>&, const StageContext<double>&, Wave<double>&, StageTally*);

namespace {

// Runs a depth's stages.
template <class S>
void runDepth(const std::vector<StageCall<S>>& stages, StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  const auto tallyOf = [tally](size_t i) { return tally == nullptr ? nullptr : tally + i; };
  for (size_t i = 0; i < stages.size();) {
    if (stages[i].repeat == Repeat::once) {
      runStage(stages[i], context, wave, tallyOf(i));
      ++i;
      continue;
    }
    // Neighbouring stages with untilJoined repeat together until no pair of vertices is left to join.
    size_t end = i;
    while (end < stages.size() && stages[end].repeat == Repeat::untilJoined) ++end;
    context.repetition = 0;
    do {
      for (size_t k = i; k < end; ++k) runStage(stages[k], context, wave, tallyOf(k));
      ++context.repetition;
    } while (wave.openPairs != 0);
    context.repetition = 0;
    i = end;
  }
}

}  // namespace

template <class S>
void runPass(const Pass<S>& pass, StageContext<S>& context, Wave<S>& wave, StageTally* tally,
             const SplatDrain<S>& drain) {
  // Begin without light vertices and without splats.
  context.walk = pass.walk;
  context.depth = 0;
  const bool storing = pass.walk == Walk::light && context.light != nullptr;
  if (storing) context.light->clear();
  wave.splats.size = 0;
  // Empties the queue of splats. The drain has the last row of the tally.
  const auto drainSplats = [&] {
    const uint64_t begin = readTicks();
    const size_t items = wave.splats.size;
    drain(wave.splats);
    if (tally == nullptr) return;
    StageTally& row = tally[pass.stageCount() - 1];
    row.ticks += readTicks() - begin;
    row.items += items;
    row.laneSlots += items;
  };
  // Generate the paths.
  runStage(pass.generate, context, wave, tally);
  // Rows of the tally follow each other: generate, stages of depth 1, stages of all other depths, the drain.
  StageTally* const first = tally == nullptr ? nullptr : tally + 1;
  StageTally* const rest = tally == nullptr ? nullptr : first + pass.firstDepth.size();
  // Go depth by depth until no path is left.
  for (context.depth = 1; context.depth <= context.limits.maxDepth && wave.rays.size != 0; ++context.depth) {
    // Each live path may leave one light vertex.
    if (storing) context.light->beginDepth(wave.rays.size);
    if (context.depth == 1 && !pass.firstDepth.empty()) {
      runDepth(pass.firstDepth, context, wave, first);
    } else {
      runDepth(pass.perDepth, context, wave, rest);
    }
    // The next depth may splat once for each live path.
    if (pass.splats && wave.splats.capacity() - wave.splats.size < wave.rays.size) drainSplats();
  }
  if (pass.splats) drainSplats();
}
template void runPass(const Pass<float>&, StageContext<float>&, Wave<float>&, StageTally*, const SplatDrain<float>&);
template void runPass(const Pass<double>&, StageContext<double>&, Wave<double>&, StageTally*,
                      const SplatDrain<double>&);

}  // namespace wavecrest
