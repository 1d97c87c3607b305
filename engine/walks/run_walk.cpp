#include "engine/walks/run_walk.h"

#include <algorithm>
#include <cmath>

#include "engine/tasks/ticks.h"
#include "engine/walks/stage_contracts.h"
#include "engine/walks/stage_observer.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {
namespace {

// Runs a stage. Adds items, lanes and ticks to the tally, if there is one.
template <class S>
void timeStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  if (tally == nullptr) {
    stage.run(context, wave);
    return;
  }
  // Items are counted first, because the stage changes the sizes of the queues.
  const size_t items = stage.countedOnce && context.light.repetition != 0 ? 0 : stage.items(wave);
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
  const bool checks = checksContracts.load(std::memory_order_relaxed);
  if (checks) requireBefore(stage.name, context, wave);
  timeStage(stage, context, wave, tally);
  if (checks) requireAfter(stage.name, context, wave);
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
    context.light.repetition = 0;
    do {
      for (size_t k = i; k < end; ++k) runStage(stages[k], context, wave, tallyOf(k));
      ++context.light.repetition;
    } while (wave.openPairs != 0);
    context.light.repetition = 0;
    i = end;
  }
}

// Ends the paths of a light walk at their last vertices and counts them all: their next rays are not traced, so some
// would have left the scene.
template <class S>
void cutPaths(Wave<S>& wave, StageCounters& counters) {
  const auto& paths = wave.paths;
  counters.cutPaths += paths.size;
  for (size_t i = 0; i < paths.size; ++i) {
    const S throughput =
        std::max({std::abs(paths.throughputR[i]), std::abs(paths.throughputG[i]), std::abs(paths.throughputB[i])});
    counters.cutThroughput += static_cast<double>(throughput * paths.rouletteScale[i]);
  }
  wave.setVertices(0, 0);
}

}  // namespace

template <class S>
void runPass(const Pass<S>& pass, StageContext<S>& context, Wave<S>& wave, StageTally* tally,
             const SplatDrain<S>& drain) {
  // Begin without light vertices and without splats.
  context.walk = pass.walk;
  context.depth = 0;
  if (pass.stores) context.light.store->clear();
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
  // Go depth by depth until no path is left. A light vertex is joined by one edge at least, so the last of K edges is
  // no light walk's.
  const bool light = pass.walk == Walk::light;
  const uint32_t last = context.limits.maxDepth - (light ? 1 : 0);
  for (context.depth = 1; context.depth <= last && wave.rays.size != 0; ++context.depth) {
    // Each live path may leave one light vertex.
    if (pass.stores) context.light.store->beginDepth(wave.rays.size);
    if (context.depth == 1 && !pass.firstDepth.empty()) {
      runDepth(pass.firstDepth, context, wave, first);
    } else {
      runDepth(pass.perDepth, context, wave, rest);
    }
    // The next depth may splat once for each live path.
    if (pass.splats && wave.splats.capacity() - wave.splats.size < wave.rays.size) drainSplats();
  }
  if (pass.splats) drainSplats();
  if (light && wave.rays.size != 0) cutPaths(wave, *context.counters);
}
template void runPass(const Pass<float>&, StageContext<float>&, Wave<float>&, StageTally*, const SplatDrain<float>&);
template void runPass(const Pass<double>&, StageContext<double>&, Wave<double>&, StageTally*,
                      const SplatDrain<double>&);

}  // namespace wavecrest
