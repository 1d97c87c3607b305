// A pipeline: the stages of a method in the order they run, and the loop that runs them on one wave.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/stages.h"

namespace wavecrest {

// How often a stage runs at each depth of its walk. A row of stages with untilJoined is repeated as a whole until all
// pairs of vertices have been joined.
enum class Repeat { once, untilJoined };

// One entry of a pass. items: how many records the stage is about to read, for the statistics; lanes: how many of them
// it works on at once.
template <class S>
struct StageCall {
  std::string_view name;
  Stage<S> run;
  size_t (*items)(const Wave<S>&);
  size_t lanes;
  Repeat repeat = Repeat::once;
};

// The strategies of path tracing, where it is not part of a bidirectional method.
constexpr MisSettings kPathTracingStrategies{.emission = true, .nextEvent = true, .powerHeuristic = true};

// What a stage works on: live paths, those at vertices that can be joined, or shadow rays.
template <class S>
size_t pathItems(const Wave<S>& wave) {
  return wave.rays.size;
}
template <class S>
size_t joinableItems(const Wave<S>& wave) {
  return wave.joinable;
}
template <class S>
size_t shadowItems(const Wave<S>& wave) {
  return wave.shadowRays.size;
}
template <class S>
size_t generatedItems(const Wave<S>& wave) {
  return wave.pathCount;
}

// One walk of a wave's paths: generated once, then depth by depth until none is left.
template <class S>
struct Pass {
  Walk walk = Walk::camera;
  MisSettings strategies{};  // the switches; constants of the iteration are filled in by the session
  StageCall<S> generate;
  std::vector<StageCall<S>> firstDepth = {};  // at depth 1, where it differs; else empty
  std::vector<StageCall<S>> perDepth = {};

  size_t stageCount() const { return 1 + firstDepth.size() + perDepth.size(); }
};

// Where the stages that join the walks of multiplexed chains work: kernels/columns/chains.h, WalkEnds.
enum class EndsOf { atOrigin, cameraAtVertex, lightAtVertex };

// A stage that runs once, on walks' ends. walk, depth: what it takes them for; ends of all depths come together.
template <class S>
struct JoinCall {
  StageCall<S> stage;
  EndsOf ends;
  Walk walk;
  uint32_t depth;
};

// What Markov chains do beside the passes: propose, then the passes with a join after each, then accept.
template <class S>
struct ChainCalls {
  StageCall<S> propose, accept;
  std::vector<JoinCall<S>> afterCamera = {}, afterLight = {};
  // In path space: what joins and weighs the walks of whole waves, and what follows an acceptance.
  std::vector<StageCall<S>> weigh = {}, commit = {};
  std::optional<Pass<S>> directPass = std::nullopt;  // paths of up to kDirectLength edges, if chains leave them out

  bool inPathSpace() const { return !weigh.empty(); }
};
constexpr uint32_t kDirectLength = 2;

// A method. With a photon map, all light passes of an iteration come before all its camera passes; with chains, the
// camera pass comes first and paths are what the chains propose.
template <class S>
struct Pipeline {
  std::optional<Pass<S>> lightPass = std::nullopt;
  bool photonMap = false;
  Pass<S> cameraPass;
  std::optional<ChainCalls<S>> chains = std::nullopt;

  // The logarithm of how many iterations a camera wave of this many paths takes at once (Wave::iterationBits), where it
  // may: camera paths that are joined with light paths of their iteration come alone.
  uint32_t mostIterationBits(uint32_t waveSize) const {
    if (lightPass || chains) return 0;
    return static_cast<uint32_t>(std::bit_width(std::min(waveSize, kIterationsPerWave))) - 1;
  }
  bool splats() const { return chains || (lightPass && lightPass->strategies.camera); }
  bool bidirectional() const { return lightPass.has_value(); }
};

// All intersectors offer the same pair of stages.
template <class S>
struct Intersector {
  Stage<S> extend, occlude;
  size_t lanes;
};

// Time and items of each stage, in pipeline order, of one worker. laneSlots: items rounded up to whole blocks.
struct StageTally {
  uint64_t items = 0, laneSlots = 0, ticks = 0;
};

// Runs one stage; tally: its entry, or nullptr to measure nothing.
template <class S>
void runStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally);

// Time-stamp counter ticks, and their length.
uint64_t readTicks();
double secondsPerTick();

// Takes one wave from generation to the end of its last path. tally: one entry per stage in the order generate,
// firstDepth, perDepth, or nullptr to measure nothing. The wave's firstPath and pathCount say which paths.
template <class S>
void runPass(const Pass<S>& pass, StageContext<S>& context, Wave<S>& wave, StageTally* tally);

}  // namespace wavecrest
