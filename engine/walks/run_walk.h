// Runs a pipeline's walks and stages on one wave.
#pragma once

#include <cstdint>
#include <functional>

#include "engine/plan/pipeline.h"

namespace wavecrest {

// Time and items of each stage, in pipeline order, of one worker. laneSlots: items rounded up to whole blocks.
struct StageTally {
  uint64_t items = 0, laneSlots = 0, ticks = 0;
};

// Runs one stage; tally: its entry, or nullptr to measure nothing.
template <class S>
void runStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally);

// Empties a wave's queue of splats. A pass calls it before the queue could overrun, and at its end.
template <class S>
using SplatDrain = std::function<void(Splats<S>&)>;

// Takes one wave from generation to the end of its last path. tally: one entry per stage in the order generate,
// firstDepth, perDepth, drain, or nullptr to measure nothing. The wave's firstPath and pathCount say which paths.
// drain: of a pass that splats.
template <class S>
void runPass(const Pass<S>& pass, StageContext<S>& context, Wave<S>& wave, StageTally* tally,
             const SplatDrain<S>& drain = {});

}  // namespace wavecrest
