#include "bench/throughput/stage_times.h"

#include <chrono>

#include "bench/throughput/cpu_timer.h"
#include "engine/flush_to_zero.h"

namespace wavecrest {

StageTimes::StageTimes(const Scene& scene, const RenderSettings& settings)
    : capture_(scene, settings),
      wave_(capture_.makeWave()),
      seconds_(capture_.plan().pipeline.cameraPass.stageCount()) {}

void StageTimes::measureFor(double seconds) {
  const FlushToZero flushToZero;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  do {
    // The observer is called right before each stage: from one call to the next is the stage in between.
    CpuTimer timer;
    size_t call = 0;
    const auto finishStage = [&] {
      const double spent = timer.seconds();
      if (call != 0) seconds_[call == 1 ? 0 : 1 + (call - 2) % (seconds_.size() - 1)] += spent;
      ++call;
    };
    capture_.trace(wave_, capture_.waveFromAllOver(nextWave_++), [&](std::string_view, uint32_t, Wave<float>&) {
      finishStage();
      timer.start();
      return true;
    });
    finishStage();
    paths_ += wave_.pathCount;
  } while (Clock::now() < end);
}

}  // namespace wavecrest
