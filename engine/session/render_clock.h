// Clocks of a session, and the limit on its worker threads.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "engine/plan/clock_kind.h"

namespace wavecrest {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// CPU time of the process up to now, all threads together.
double processCpuSeconds();

// The clock of a session. It runs while the session renders; other threads may read it meanwhile.
class RenderClock {
 public:
  RenderClock(ClockKind kind, unsigned threads) : kind_(kind), threads_(threads) {}

  // What is charged up to the last stop, and both clocks there.
  double seconds() const { return charged(wallSeconds_, cpuSeconds_); }
  double wallSeconds() const { return wallSeconds_; }
  double cpuSeconds() const { return cpuSeconds_; }
  // Seconds as of the last look, from any thread.
  double shown() const { return shown_.load(std::memory_order_relaxed); }
  // Goes on where the clock of another session stopped.
  void goOnFrom(double wallSeconds, double cpuSeconds);

  // The clock runs while this lives.
  class Running {
   public:
    explicit Running(RenderClock& clock) : clock_(clock) {}
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    // Seconds now, which other threads see from now on. Safe from several threads.
    double look() const;

   private:
    RenderClock& clock_;
    const Clock::time_point begin_ = Clock::now();
    const double cpuBegin_ = processCpuSeconds();
  };

 private:
  double charged(double wall, double cpu) const;

  const ClockKind kind_;
  const double threads_;
  double wallSeconds_ = 0, cpuSeconds_ = 0;
  std::atomic<double> shown_{0};
};

// Lets the arena of a session have more threads than the machine has cores while the session works: TBB has no workers
// for them otherwise. The least of all limits alive counts for the whole process, so none is below the number of cores;
// it is the arena that holds a session to fewer threads.
struct WorkerLimit {
  explicit WorkerLimit(size_t threads)
      : control(oneapi::tbb::global_control::max_allowed_parallelism,
                std::max(threads, static_cast<size_t>(oneapi::tbb::info::default_concurrency()))) {}
  oneapi::tbb::global_control control;
};

}  // namespace wavecrest
