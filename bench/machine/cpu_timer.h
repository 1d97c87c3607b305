// CpuTimer: the CPU time that the calling thread spends on a few microseconds of work.
//
// CPU time leaves out what other programs took from the core meanwhile. Reading the clock is a system call, whose own
// cost is measured once and subtracted.
#pragma once

#include <algorithm>
#include <array>
#include <ctime>

namespace wavecrest {

inline double threadCpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class CpuTimer {
 public:
  void start() { begin_ = threadCpuSeconds(); }
  // Seconds since start(), never negative.
  double seconds() const { return std::max(threadCpuSeconds() - begin_ - readingCost(), 0.0); }

 private:
  static double readingCost() {
    static const double cost = [] {
      std::array<double, 101> costs{};
      for (double& c : costs) {
        const double begin = threadCpuSeconds();
        c = threadCpuSeconds() - begin;
      }
      std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
      return costs[costs.size() / 2];
    }();
    return cost;
  }

  double begin_ = 0;
};

}  // namespace wavecrest
