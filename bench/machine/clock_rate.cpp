#include "bench/machine/clock_rate.h"

#include <algorithm>
#include <cstdint>

#include "bench/machine/cpu_timer.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSteps = 1u << 18, kTries = 8;
constexpr double kCyclesPerStep = 3;

}  // namespace

double measuredMhz() {
  double best = 0;
  uint64_t value = 3;
  for (uint32_t attempt = 0; attempt < kTries; ++attempt) {
    const double begin = threadCpuSeconds();
    for (uint32_t i = 0; i < kSteps; ++i) {
      value *= value;
      asm volatile("" : "+r"(value));  // each product is needed by the next
    }
    const double seconds = threadCpuSeconds() - begin;
    if (seconds > 0) best = std::max(best, kSteps * kCyclesPerStep / seconds);
  }
  return 1e-6 * best;
}

}  // namespace wavecrest
