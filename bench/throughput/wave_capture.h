// WaveCapture: real waves of a render, stopped at the stage one wants to look at.
//
// in: a scene and settings, as for a session, of a method without light paths and chains. out: waves as they are right
// before a stage of the pipeline runs, and the context to run stages on them. For microbenchmarks, and for recording
// the rays that a render traces.
#pragma once

#include <functional>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/plan/render_plan.h"
#include "engine/plan/survival.h"

namespace wavecrest {

// The i-th index of a walk over all of `count` in large steps: any first few of them are spread over the whole.
inline size_t spreadIndex(size_t i, size_t count) {
  size_t step = count / 7 * 3 + 1;
  // Steps that share a factor with the count would leave indices out.
  while (std::gcd(step, count) != 1) ++step;
  return i * step % count;
}

template <class S>
class WaveCapture {
 public:
  WaveCapture(const Scene& scene, const RenderSettings& settings);

  // Whether camera paths are all that the method traces: only then do waves come without what is built before them.
  bool tracesWholeMethod() const { return !plan_.pipeline.lightPass() && !plan_.pipeline.chains; }

  // Called with the name of the stage that is about to run, its depth and the wave; returns whether to go on.
  using Observer = std::function<bool(std::string_view stage, uint32_t depth, Wave<S>& wave)>;

  // Traces the wave of the given index, of the first iterations, until its paths have ended or the observer has seen
  // enough.
  void trace(Wave<S>& wave, size_t index, const Observer& observer);

  // The middle wave of the film as it is right before `stage` runs at `depth` (0 for generate); where all of its paths
  // have ended by then, the next that gets there. Throws std::runtime_error if none does.
  Wave<S> before(std::string_view stage, uint32_t depth);

  Wave<S> makeWave() const { return Wave<S>(settings_.waveSize, plan_.needs); }
  StageContext<S> context(uint32_t depth);
  size_t waveFromAllOver(size_t i) const { return spreadIndex(i, waveCount()); }
  size_t waveCount() const { return (pixels_.size() + pixelsPerWave() - 1) / pixelsPerWave(); }
  RenderPlan<S>& plan() { return plan_; }
  const StageCounters& counters() const { return counters_; }

 private:
  size_t pixelsPerWave() const { return settings_.waveSize >> iterationBits_; }

  const RenderSettings settings_;
  RenderPlan<S> plan_;
  std::optional<SurvivalRule> survival_;
  uint32_t iterationBits_ = 0;    // of all waves, as a session has them that has been running for a while
  std::vector<uint32_t> pixels_;  // of the film, in wave order
  StageCounters counters_;
};

}  // namespace wavecrest
