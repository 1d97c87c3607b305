// Sums of what a render learns: integers, so that they are the same in any order, on any number of threads.
//
// Nothing that is added is negative. A sum that reaches kSumLimit stays there and counts as saturated.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace wavecrest {

constexpr uint64_t kSumLimit = uint64_t{1} << 62;
// One addend is at most this. Threads that add at the same time overshoot the limit by one each: with 4096 threads, the
// most that a render may have, sums stay below 2^62 + 4096 x 2^51 < 2^64.
constexpr double kAddendLimit = 0x1p51;

// Rounds a value in units; one that is not finite and positive adds nothing.
inline uint64_t toAddend(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 0;
  return static_cast<uint64_t>(std::min(value, kAddendLimit) + 0.5);
}

// Safe from several threads.
inline void addTo(uint64_t& sum, uint64_t addend) {
  if (addend == 0) return;
  const std::atomic_ref<uint64_t> shared(sum);
  if (shared.fetch_add(addend, std::memory_order_relaxed) + addend < kSumLimit) [[likely]]
    return;
  shared.store(kSumLimit, std::memory_order_relaxed);
}

}  // namespace wavecrest
