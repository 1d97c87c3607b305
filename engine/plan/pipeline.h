// A pipeline: a method's page (engine/methods/method_page.h) with the kernels that it calls, as data. engine/walks runs
// it on waves.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/methods/method_page.h"
#include "kernels/stages.h"

namespace wavecrest {

// One stage of a pipeline: what runs, and its row of the statistics. items: how many records the stage is about to
// read; lanes: how many of them it works on at once.
template <class S>
struct StageCall {
  std::string name;
  Stage<S> run;
  size_t (*items)(const Wave<S>&);
  size_t lanes;
  Repeat repeat = Repeat::once;
  // Repetitions go on with the items of the first: how many there are depends on the size of waves, so they are not
  // counted again.
  bool countedOnce = false;
};

// One walk of a wave's paths: generated once, then depth by depth until none is left.
template <class S>
struct Pass {
  Walk walk = Walk::camera;
  MisSettings strategies{};  // the switches; constants of the iteration are filled in by the session
  StageCall<S> generate;
  std::vector<StageCall<S>> firstDepth = {};  // at depth 1, where it differs; else empty
  std::vector<StageCall<S>> perDepth = {};
  bool stores = false;  // its vertices are stored in the context's light store
  bool splats = false;  // its contributions are splats, which a SplatDrain takes to the film

  // Rows of its statistics: its stages, and what the drain does.
  size_t stageCount() const { return 1 + firstDepth.size() + perDepth.size() + (splats ? 1 : 0); }
};

// Stages that run once, on the wave or on the ends of its walks (OncePhase). decides: they begin with acceptMutations.
template <class S>
struct OnceCalls {
  std::vector<StageCall<S>> stages;
  bool decides = false;
  EndsOf ends = EndsOf::wave;
  Walk walk = Walk::camera;
  uint32_t depth = 0;
};

constexpr uint32_t kDirectLength = 2;

// The phases between two barriers. A wave goes through them one after the other and waits for no other wave. fold: at
// the barrier behind them, if there is one.
template <class S>
struct Stretch {
  std::vector<std::variant<Pass<S>, OnceCalls<S>>> phases;
  std::optional<Fold> fold;

  const Pass<S>* pass(Walk walk) const;  // null if there is none
};

// A method's page with the kernels that it calls: an iteration goes through the stretches in order.
template <class S>
struct Pipeline {
  std::vector<Stretch<S>> stretches;
  std::vector<Fold> lessons;  // at the end of each block of iterations
  // Paths are what Markov chains propose: in their one stretch all phases but those that decide trace a proposal and
  // its contribution.
  bool chains = false;
  bool inPathSpace = false;
  std::optional<Pass<S>> directPass = std::nullopt;  // paths of up to kDirectLength edges, if chains leave them out

  const Pass<S>* pass(Walk walk) const;  // null if there is none
  const Pass<S>* lightPass() const { return pass(Walk::light); }
  const Pass<S>& cameraPass() const { return *pass(Walk::camera); }
  bool has(Fold fold) const;  // at a barrier within an iteration, or behind a block of them

  // The logarithm of how many iterations a camera wave of this many paths takes at once (Wave::iterationBits), where it
  // may: camera paths that are joined with light paths of their iteration come alone.
  uint32_t mostIterationBits(uint32_t waveSize) const {
    if (lightPass() != nullptr || chains) return 0;
    return static_cast<uint32_t>(std::bit_width(std::clamp(waveSize, 1u, kIterationsPerWave))) - 1;
  }
  bool splats() const { return chains || (lightPass() != nullptr && lightPass()->splats); }
};

// All intersectors offer the same pair of stages.
template <class S>
struct Intersector {
  Stage<S> extend, occlude;
  size_t lanes;
};

// The page's stages, of these kernels and this intersector.
template <class S>
Pipeline<S> makePipeline(const MethodPage& page, const Stages<S>& stages, const Intersector<S>& intersector);

}  // namespace wavecrest
