#include "bench/machine/perf_events.h"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace wavecrest {
namespace {

constexpr size_t kMostEvents = 8;

int openEvent(const PerfEvent& event, int leader) {
  perf_event_attr attributes{};
  attributes.size = sizeof attributes;
  attributes.type = event.type;
  attributes.config = event.config;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  attributes.read_format = PERF_FORMAT_GROUP;
  constexpr pid_t kThisThread = 0;
  constexpr int kAnyCore = -1;
  return static_cast<int>(
      syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyCore, leader, PERF_FLAG_FD_CLOEXEC));
}

}  // namespace

const std::array<PerfEvent, kStageEvents> kHardwareEvents{{{PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
                                                           {PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
                                                           {PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES}}};

PerfGroup::PerfGroup(std::span<const PerfEvent> events) {
  for (const PerfEvent& event : events.first(std::min(events.size(), kMostEvents))) {
    const int file = openEvent(event, files_.empty() ? -1 : files_.front());
    if (file < 0) {
      refusal_ = std::string("perf_event_open: ") + std::strerror(errno);
      break;
    }
    files_.push_back(file);
  }
}

PerfGroup::~PerfGroup() {
  for (const int file : files_) close(file);
}

void PerfGroup::read(std::span<uint64_t> counts) const {
  std::fill(counts.begin(), counts.end(), uint64_t{0});
  if (!refusal_.empty() || files_.empty()) return;
  std::array<uint64_t, 1 + kMostEvents> values{};  // how many, and the counts
  if (::read(files_.front(), values.data(), sizeof values) < 0) return;
  const size_t count = std::min<size_t>({values[0], counts.size(), kMostEvents});
  std::copy_n(values.begin() + 1, count, counts.begin());
}

StageEventCounter::StageEventCounter(const std::array<PerfEvent, kStageEvents>& events) : group_(events) {
  if (refusal().empty()) stageObserver = this;
}

StageEventCounter::~StageEventCounter() { stageObserver = nullptr; }

void StageEventCounter::begin() { group_.read(begin_); }

void StageEventCounter::end(const std::string& name) {
  StageEvents now{};
  group_.read(now);
  StageEvents& sums = sums_[name];
  for (size_t i = 0; i < kStageEvents; ++i) sums[i] += now[i] - begin_[i];
}

}  // namespace wavecrest
