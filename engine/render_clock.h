// Clocks of a session, and the limit on its worker threads.
#pragma once

#include <oneapi/tbb/global_control.h>

#include <chrono>

namespace wavecrest {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// CPU time of the process up to now, all threads together.
double processCpuSeconds();

// TBB gives an arena of more threads than the machine has cores no workers for the surplus unless it is told to. Only
// while a session works: the least of all limits alive counts, and several sessions may be.
struct WorkerLimit {
  explicit WorkerLimit(size_t threads) : control(oneapi::tbb::global_control::max_allowed_parallelism, threads) {}
  oneapi::tbb::global_control control;
};

}  // namespace wavecrest
