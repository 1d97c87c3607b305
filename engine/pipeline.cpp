#include "engine/pipeline.h"

#include <x86intrin.h>

#include <chrono>
#include <thread>

namespace wavecrest {

uint64_t readTicks() { return __rdtsc(); }

double secondsPerTick() {
  using Clock = std::chrono::steady_clock;
  static const double value = [] {
    const auto begin = Clock::now();
    const uint64_t first = readTicks();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const uint64_t ticks = readTicks() - first;
    return std::chrono::duration<double>(Clock::now() - begin).count() / static_cast<double>(ticks);
  }();
  return value;
}

namespace {

template <class S>
void call(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  if (tally == nullptr) {
    stage.run(context, wave);
    return;
  }
  const size_t items = stage.items(wave);
  tally->items += items;
  tally->laneSlots += (items + stage.lanes - 1) / stage.lanes * stage.lanes;
  const uint64_t begin = readTicks();
  stage.run(context, wave);
  tally->ticks += readTicks() - begin;
}

}  // namespace

template <class S>
void runWave(const Pipeline<S>& pipeline, StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  context.depth = 0;
  call(pipeline.generate, context, wave, tally);
  for (context.depth = 1; context.depth <= context.limits.maxDepth && wave.rays.size != 0; ++context.depth) {
    for (size_t i = 0; i < pipeline.perDepth.size(); ++i) {
      call(pipeline.perDepth[i], context, wave, tally == nullptr ? nullptr : tally + 1 + i);
    }
  }
}
template void runWave(const Pipeline<float>&, StageContext<float>&, Wave<float>&, StageTally*);
template void runWave(const Pipeline<double>&, StageContext<double>&, Wave<double>&, StageTally*);

}  // namespace wavecrest
