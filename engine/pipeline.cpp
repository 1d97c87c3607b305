#include "engine/pipeline.h"

#include <x86intrin.h>

#include <chrono>
#include <thread>

#include "kernels/columns/light_vertices.h"

namespace wavecrest {

uint64_t readTicks() { return __rdtsc(); }

namespace {

// The two clocks at the same moment: of several readings the one that was disturbed least.
struct Moment {
  std::chrono::steady_clock::time_point time;
  uint64_t ticks = 0;
};
Moment readBothClocks() {
  using Clock = std::chrono::steady_clock;
  Moment best;
  Clock::duration least = Clock::duration::max();
  for (int attempt = 0; attempt < 16; ++attempt) {
    const auto before = Clock::now();
    const uint64_t ticks = readTicks();
    const Clock::duration taken = Clock::now() - before;
    if (taken < least) {
      least = taken;
      best = {before + taken / 2, ticks};
    }
  }
  return best;
}

}  // namespace

double secondsPerTick() {
  static const double value = [] {
    const Moment begin = readBothClocks();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Moment end = readBothClocks();
    return std::chrono::duration<double>(end.time - begin.time).count() / static_cast<double>(end.ticks - begin.ticks);
  }();
  return value;
}

template <class S>
void runStage(const StageCall<S>& stage, const StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
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
template void runStage(const StageCall<float>&, const StageContext<float>&, Wave<float>&, StageTally*);
template void runStage(const StageCall<double>&, const StageContext<double>&, Wave<double>&, StageTally*);

namespace {

// Runs a depth's stages.
template <class S>
void runDepth(const std::vector<StageCall<S>>& stages, StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  const auto tallyOf = [tally](size_t i) { return tally == nullptr ? nullptr : tally + i; };
  for (size_t i = 0; i < stages.size();) {
    if (stages[i].repeat == Repeat::once) {
      runStage(stages[i], context, wave, tallyOf(i));
      ++i;
      continue;
    }
    size_t end = i;
    while (end < stages.size() && stages[end].repeat == Repeat::untilJoined) ++end;
    context.repetition = 0;
    do {
      for (size_t k = i; k < end; ++k) runStage(stages[k], context, wave, tallyOf(k));
      ++context.repetition;
    } while (wave.openPairs != 0);
    i = end;
  }
}

}  // namespace

template <class S>
void runPass(const Pass<S>& pass, StageContext<S>& context, Wave<S>& wave, StageTally* tally) {
  context.walk = pass.walk;
  context.depth = 0;
  const bool storing = pass.walk == Walk::light && context.light != nullptr;
  if (storing) context.light->clear();
  runStage(pass.generate, context, wave, tally);
  StageTally* const first = tally == nullptr ? nullptr : tally + 1;
  StageTally* const rest = tally == nullptr ? nullptr : first + pass.firstDepth.size();
  for (context.depth = 1; context.depth <= context.limits.maxDepth && wave.rays.size != 0; ++context.depth) {
    if (storing) context.light->beginDepth(wave.rays.size);
    if (context.depth == 1 && !pass.firstDepth.empty()) {
      runDepth(pass.firstDepth, context, wave, first);
    } else {
      runDepth(pass.perDepth, context, wave, rest);
    }
  }
}
template void runPass(const Pass<float>&, StageContext<float>&, Wave<float>&, StageTally*);
template void runPass(const Pass<double>&, StageContext<double>&, Wave<double>&, StageTally*);

}  // namespace wavecrest
