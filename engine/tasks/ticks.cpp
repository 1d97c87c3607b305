#include "engine/tasks/ticks.h"

#include <x86intrin.h>

#include <chrono>
#include <thread>

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
  // Measured once for the process, over 20 ms.
  static const double value = [] {
    const Moment begin = readBothClocks();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Moment end = readBothClocks();
    return std::chrono::duration<double>(end.time - begin.time).count() / static_cast<double>(end.ticks - begin.ticks);
  }();
  return value;
}

}  // namespace wavecrest
