// What one worker thread of a session keeps from wave to wave. Nothing is allocated while waves run, unless they have
// more light vertices than the memory plan foresees.
#pragma once

#include <optional>
#include <vector>

#include "engine/film/film.h"
#include "engine/plan/render_plan.h"
#include "engine/walks/run_walk.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

template <class S>
struct WaveWorker {
  Wave<S> wave;
  // Of the wave under way: of its light walk, or with a photon map what its camera paths are connected with, where no
  // store has just that (WaveSession::partnersOf).
  LightStore<S> light;
  StageCounters counters;
  std::vector<StageTally> lightTallies, cameraTallies;
  StageTally photonTally;  // of building the photon map
  std::optional<SplatWriter<S>> splats;
  uint64_t paths = 0, lightPaths = 0;

  WaveWorker(const RenderPlan<S>& plan, uint32_t waveSize, Film& film)
      : wave(waveSize, plan.needs),
        light(waveSize, plan.needs, {.merged = false}),
        cameraTallies(plan.pipeline.cameraPass().stageCount()) {
    if (plan.pipeline.lightPass()) {
      lightTallies.resize(plan.pipeline.lightPass()->stageCount());
      light.reserve(plan.memory.partnerVertices);
    }
    if (plan.pipeline.splats()) splats.emplace(film.splats(), plan.stages->addSplats, waveSize);
  }
};

}  // namespace wavecrest
