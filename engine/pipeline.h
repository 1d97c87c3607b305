// A pipeline: the stages of a method in the order they run, and the loop that runs them on one wave.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/stages.h"

namespace wavecrest {

// One entry of a pipeline. items: how many records the stage is about to read, for the statistics; lanes: how many of
// them it works on at once.
template <class S>
struct StageCall {
  std::string_view name;
  Stage<S> run;
  size_t (*items)(const Wave<S>&);
  size_t lanes;
};

// What a stage works on: rays of live paths, or shadow rays.
template <class S>
size_t pathItems(const Wave<S>& wave) {
  return wave.rays.size;
}
template <class S>
size_t shadowItems(const Wave<S>& wave) {
  return wave.shadowRays.size;
}

template <class S>
struct Pipeline {
  StageCall<S> generate;
  std::vector<StageCall<S>> perDepth;

  size_t stageCount() const { return 1 + perDepth.size(); }
};

// The two intersectors offer the same pair of stages.
template <class S>
struct Intersector {
  Stage<S> extend, occlude;
  size_t lanes;
};

// Time and items of each stage, in pipeline order, of one worker. laneSlots: items rounded up to whole blocks.
struct StageTally {
  uint64_t items = 0, laneSlots = 0, ticks = 0;
};

// Time-stamp counter ticks, and their length.
uint64_t readTicks();
double secondsPerTick();

// Takes one wave from generation to the end of its last path. tally: one entry per stage, or nullptr to measure
// nothing. The wave's firstPath and pathCount say which paths.
template <class S>
void runWave(const Pipeline<S>& pipeline, StageContext<S>& context, Wave<S>& wave, StageTally* tally);

}  // namespace wavecrest
