// What one worker thread of a session keeps from wave to wave; nothing is allocated while waves run.
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
  LightStore<S> light;  // of the wave under way, where light vertices do not outlive it
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
      if (!plan.pipeline.has(Fold::photonMap)) light.reserve(plan.memory.verticesPerWave);
    }
    if (plan.pipeline.splats()) splats.emplace(film.splats(), plan.stages->addSplats, waveSize);
  }
};

}  // namespace wavecrest
