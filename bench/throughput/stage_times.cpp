#include "bench/throughput/stage_times.h"

#include <chrono>

#include "bench/throughput/cpu_timer.h"
#include "bench/throughput/wave_capture.h"
#include "engine/flush_to_zero.h"

namespace wavecrest {

std::optional<StageTimes> measureStageTimes(const Scene& scene, const RenderSettings& settings, double seconds) {
  const FlushToZero flushToZero;
  WaveCapture<float> capture(scene, settings);
  if (!capture.tracesWholeMethod()) return std::nullopt;
  Wave<float> wave = capture.makeWave();
  const size_t stages = capture.plan().pipeline.cameraPass.stageCount();
  StageTimes times{.paths = 0, .seconds = std::vector<double>(stages)};

  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (size_t index = 0; index == 0 || Clock::now() < end; ++index) {
    // The observer is called right before each stage: from one call to the next is the stage in between.
    CpuTimer timer;
    size_t call = 0;
    const auto finishStage = [&] {
      const double spent = timer.seconds();
      if (call != 0) times.seconds[call == 1 ? 0 : 1 + (call - 2) % (stages - 1)] += spent;
      ++call;
    };
    capture.trace(wave, capture.waveFromAllOver(index), [&](std::string_view, uint32_t, Wave<float>&) {
      finishStage();
      timer.start();
      return true;
    });
    finishStage();
    times.paths += wave.pathCount;
  }
  return times;
}

}  // namespace wavecrest
