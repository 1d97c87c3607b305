#include "bench/machine/clock_rate.h"

#include <algorithm>
#include <cstdint>
#include <ctime>

namespace wavecrest {
namespace {

constexpr uint32_t kSteps = 1u << 18, kTries = 8;
constexpr double kCyclesPerStep = 3;

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double measuredMhz() {
  double best = 0;
  uint64_t value = 3;
  for (uint32_t attempt = 0; attempt < kTries; ++attempt) {
    const double begin = threadSeconds();
    for (uint32_t i = 0; i < kSteps; ++i) {
      value *= value;
      asm volatile("" : "+r"(value));  // each product is needed by the next
    }
    const double seconds = threadSeconds() - begin;
    if (seconds > 0) best = std::max(best, kSteps * kCyclesPerStep / seconds);
  }
  return 1e-6 * best;
}

}  // namespace wavecrest
