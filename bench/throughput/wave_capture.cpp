#include "bench/throughput/wave_capture.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace wavecrest {

template <class S>
WaveCapture<S>::WaveCapture(const Scene& scene, const RenderSettings& settings)
    : settings_(withinDepthOfMethod(settings)),
      plan_(planRender<S>(scene, settings_)),
      survival_(survivalRule(settings_, Walk::camera)),
      iterationBits_(plan_.pipeline.mostIterationBits(settings.waveSize)),
      pixels_(filmArea(scene.film).pixels) {
  plan_.needs.visibility = true;  // rays of one intersector are traced by others too
}

template <class S>
StageContext<S> WaveCapture<S>::context(uint32_t depth) {
  return {.scene = &plan_.view,
          .pixels = pixels_.data(),
          .sampler = {settings_.sampler, settings_.seed, 0},
          .limits = settings_.limits,
          .survival = pointerTo(survival_),
          .mis = plan_.pipeline.cameraPass().strategies,
          .depth = depth,
          .film = {},
          .counters = &counters_};
}

template <class S>
void WaveCapture<S>::trace(Wave<S>& wave, size_t index, const Observer& observer) {
  if (!tracesWholeMethod()) throw std::logic_error("WaveCapture: a method with light paths or chains");
  wave.firstPath = index * pixelsPerWave();
  wave.pathCount = std::min(pixelsPerWave(), pixels_.size() - wave.firstPath) << iterationBits_;
  wave.iterationBits = iterationBits_;
  StageContext<S> context = this->context(0);
  const auto run = [&](const StageCall<S>& stage) {
    if (!observer(stage.name, context.depth, wave)) return false;
    stage.run(context, wave);
    return true;
  };
  if (!run(plan_.pipeline.cameraPass().generate)) return;
  for (context.depth = 1; context.depth <= context.limits.maxDepth && wave.rays.size != 0; ++context.depth) {
    for (const StageCall<S>& stage : plan_.pipeline.cameraPass().perDepth) {
      if (!run(stage)) return;
    }
  }
}

template <class S>
Wave<S> WaveCapture<S>::before(std::string_view stage, uint32_t depth) {
  Wave<S> wave = makeWave();
  bool found = false;
  const auto untilStage = [&](std::string_view name, uint32_t at, Wave<S>&) {
    found = name == stage && at == depth;
    return !found;
  };
  for (size_t tried = 0; tried < waveCount() && !found; ++tried) {
    trace(wave, (waveCount() / 2 + tried) % waveCount(), untilStage);
  }
  if (!found) throw std::runtime_error("no path reached " + std::string(stage) + " at depth " + std::to_string(depth));
  return wave;
}

template class WaveCapture<float>;
template class WaveCapture<double>;

}  // namespace wavecrest
