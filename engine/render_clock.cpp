#include "engine/render_clock.h"

#include <sys/resource.h>

namespace wavecrest {

double processCpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void RenderClock::goOnFrom(double seconds, double cpuSeconds) {
  seconds_ = seconds;
  cpuSeconds_ = cpuSeconds;
  shown_.store(seconds, std::memory_order_relaxed);
}

double RenderClock::Running::look() const {
  const double now = clock_.seconds_ + secondsSince(begin_);
  clock_.shown_.store(now, std::memory_order_relaxed);
  return now;
}

RenderClock::Running::~Running() {
  clock_.goOnFrom(clock_.seconds_ + secondsSince(begin_), clock_.cpuSeconds_ + processCpuSeconds() - cpuBegin_);
}

}  // namespace wavecrest
