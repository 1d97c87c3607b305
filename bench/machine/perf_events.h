// Counters of the processor by Linux' perf_event_open: of the calling thread, in user mode.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/walks/stage_observer.h"

namespace wavecrest {

// As perf_event_open has them: PERF_TYPE_HARDWARE and PERF_COUNT_HW_CPU_CYCLES, for instance.
struct PerfEvent {
  uint32_t type = 0;
  uint64_t config = 0;
};

// Events that are counted together from the construction on, of the thread that constructs it.
class PerfGroup {
 public:
  explicit PerfGroup(std::span<const PerfEvent> events);
  ~PerfGroup();
  PerfGroup(const PerfGroup&) = delete;
  PerfGroup& operator=(const PerfGroup&) = delete;

  // Why nothing is counted: what the system said. Empty if all events are.
  const std::string& refusal() const { return refusal_; }
  // Counts so far, one of each event; zeros if nothing is counted.
  void read(std::span<uint64_t> counts) const;

 private:
  std::vector<int> files_;  // the first is the group's leader
  std::string refusal_;
};

constexpr size_t kStageEvents = 3;
using StageEvents = std::array<uint64_t, kStageEvents>;
extern const std::array<PerfEvent, kStageEvents> kHardwareEvents;  // cycles, instructions, cache misses
constexpr std::array<const char*, kStageEvents> kHardwareEventNames{"cycles", "instructions", "cache_misses"};

// Counts events of each stage of renders on one thread that measure their stages, while it lives. At most one lives at
// a time.
class StageEventCounter : public StageObserver {
 public:
  explicit StageEventCounter(const std::array<PerfEvent, kStageEvents>& events = kHardwareEvents);
  ~StageEventCounter() override;
  StageEventCounter(const StageEventCounter&) = delete;
  StageEventCounter& operator=(const StageEventCounter&) = delete;

  const std::string& refusal() const { return group_.refusal(); }
  // Since the last call, by the stage's row in the statistics; empty where nothing is counted.
  std::map<std::string, StageEvents> take() { return std::exchange(sums_, {}); }

  void begin() override;
  void end(const std::string& name) override;

 private:
  const PerfGroup group_;
  StageEvents begin_{};
  std::map<std::string, StageEvents> sums_;
};

}  // namespace wavecrest
