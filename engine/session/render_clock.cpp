#include "engine/session/render_clock.h"

#include <ctime>

namespace wavecrest {

double processCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double RenderClock::charged(double wall, double cpu) const { return kind_ == ClockKind::cpu ? cpu / threads_ : wall; }

void RenderClock::goOnFrom(double wallSeconds, double cpuSeconds) {
  wallSeconds_ = wallSeconds;
  cpuSeconds_ = cpuSeconds;
  shown_.store(seconds(), std::memory_order_relaxed);
}

double RenderClock::Running::look() const {
  // The CPU's clock takes a system call, so it is read only where it counts.
  const double cpu = clock_.kind_ == ClockKind::cpu ? clock_.cpuSeconds_ + processCpuSeconds() - cpuBegin_ : 0;
  const double now = clock_.charged(clock_.wallSeconds_ + secondsSince(begin_), cpu);
  clock_.shown_.store(now, std::memory_order_relaxed);
  return now;
}

RenderClock::Running::~Running() {
  clock_.goOnFrom(clock_.wallSeconds_ + secondsSince(begin_), clock_.cpuSeconds_ + processCpuSeconds() - cpuBegin_);
}

}  // namespace wavecrest
