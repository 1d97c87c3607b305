#include "bench/machine/machine_watch.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "bench/machine/clock_rate.h"

namespace wavecrest {
namespace {

constexpr double kQuietCores = 0.1;    // that others may use unnoticed: a desktop does
constexpr double kStolenCores = 0.02;  // a hypervisor with room steals nothing
constexpr double kSteadyClock = 0.05;  // relative change of the clock rate

double nowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// CPU seconds of this process and of its children that have ended, in user and in kernel mode.
double ownSeconds() {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  double sum = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
  return sum;
}

// CPU seconds of the whole machine; nothing where /proc/stat does not tell.
std::optional<CpuTimes> cpuTimes() {
  return parseProcStat(systemFile("/proc/stat"), static_cast<double>(sysconf(_SC_CLK_TCK)));
}

}  // namespace

MachineWatch::MachineWatch() : begin_(nowSeconds()), ownBegin_(ownSeconds()), timesBegin_(cpuTimes()) {
  slowest_ = fastest_ = measuredMhz();
}

void MachineWatch::look() {
  const double mhz = measuredMhz();
  slowest_ = std::min(slowest_, mhz);
  fastest_ = std::max(fastest_, mhz);
}

MachineState MachineWatch::state() const {
  MachineState state{.seconds = nowSeconds() - begin_,
                     .othersCores = std::nullopt,
                     .stolenCores = std::nullopt,
                     .slowestMhz = slowest_,
                     .fastestMhz = fastest_};
  // Without /proc/stat only time and clock rates are known.
  const std::optional<CpuTimes> times = cpuTimes();
  if (!times || !timesBegin_ || state.seconds <= 0) return state;
  // Busy time includes all programs, also this one and its children.
  const double busy = times->busy - timesBegin_->busy, own = ownSeconds() - ownBegin_;
  // A kernel that keeps no such count leaves zeros, although at least this process was busy.
  if (busy <= 0) return state;
  // CPU seconds over wall seconds are cores. The kernel counts in ticks, so a difference may be below zero.
  state.othersCores = std::max((busy - own) / state.seconds, 0.0);
  state.stolenCores = (times->steal - timesBegin_->steal) / state.seconds;
  return state;
}

// A sentence for each figure beyond its limit.
std::vector<std::string> doubtsAbout(const MachineState& state) {
  std::vector<std::string> doubts;
  if (state.othersCores && *state.othersCores > kQuietCores) {
    doubts.push_back(
        fmt::format("other programs kept {:.2f} cores busy: wall-clock figures are too low", *state.othersCores));
  }
  if (state.stolenCores && *state.stolenCores > kStolenCores) {
    doubts.push_back(fmt::format("the hypervisor took {:.2f} cores away (steal time)", *state.stolenCores));
  }
  if (state.slowestMhz > 0 && state.fastestMhz > (1 + kSteadyClock) * state.slowestMhz) {
    doubts.push_back(
        fmt::format("the clock rate was not steady: {:.0f} to {:.0f} MHz", state.slowestMhz, state.fastestMhz));
  }
  return doubts;
}

}  // namespace wavecrest
