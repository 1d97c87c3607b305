// What one worker thread needs to advance waves of chains, and the step itself.
#pragma once

#include <optional>
#include <vector>

#include "engine/plan/render_plan.h"
#include "engine/walks/run_walk.h"
#include "kernels/columns/chains.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

// The context of a chain's stages: everything but the chains themselves. The plan must outlive it.
template <class S>
StageContext<S> chainContext(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

template <class S>
class ChainWorker {
 public:
  StageCounters counters;
  std::vector<StageTally> tallies;  // in the order of stageNames
  StageTally directTally;

  ChainWorker(const RenderPlan<S>& plan, size_t capacity, SplatFilms& films);

  // Proposes and traces one path for each of the first `count` chains, whose radiance is in the wave afterwards,
  // without deciding anything. What the proposals depend on is in the chains' columns and samples, and in
  // context.sampler; in path space also the chains' paths, without which every proposal is made anew.
  void trace(StageContext<S> context, ChainState& chains, size_t count, bool measure, PathStore<S>* paths = nullptr);
  // Accepts or rejects what trace has proposed.
  void decide(StageContext<S> context, ChainState& chains, bool measure);

  // Traces the direct light of pixels [first, first + count) of the area by path tracing, for the film.
  void traceDirect(StageContext<S> context, const FilmArea& area, size_t first, size_t count);

  const Wave<S>& wave() const { return wave_; }
  // In path space: what trace has proposed.
  const PathMutations<S>& mutations() const { return *paths_; }
  size_t bytesPerPath() { return wave_.bytesPerPath(); }
  bool joinsWalks() const { return ends_.has_value(); }
  size_t splatBytes() const { return splats_.bytes(); }
  size_t lightBytes() const { return joinsWalks() ? light_.bytes() : 0; }
  size_t pathBytes() const {
    return paths_ ? PathMutations<S>::bytesFor(wave_.rays.capacity(), law_.maxEdges, needs_) : 0;
  }

 private:
  void walkPaths(const Pass<S>& pass, StageContext<S>& context, size_t count, StageTally* tally);
  void runOnce(const OnceCalls<S>& calls, StageContext<S>& context, StageTally* tally);
  size_t chooseLightLanes(const Chains& chains, size_t count);

  const Pipeline<S>& pipeline_;
  Wave<S> wave_;
  std::optional<WalkEnds<S>> ends_;
  LightStore<S> light_;
  const PathLaw law_;
  const ColumnNeeds needs_;
  std::optional<PathMutations<S>> paths_;
  SplatWriter<S> splats_;
  Arena lanesArena_;
  Column<uint32_t> lightLanes_;  // lanes whose light walk is worth its while
};

// The rows of --stats that ChainWorker::tallies are of.
template <class S>
std::vector<std::string> stageNames(const Pipeline<S>& pipeline);

}  // namespace wavecrest
