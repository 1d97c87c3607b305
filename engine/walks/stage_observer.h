// Somebody who wants to know when a stage begins and ends on a thread, in renders that measure their stages: to count
// the processor's events (bench/machine/perf_events.h). Without one, a stage reads one more pointer.
#pragma once

#include <atomic>
#include <string>

namespace wavecrest {

class StageObserver {
 public:
  virtual ~StageObserver() = default;
  // Called on the thread that runs the stage, right before and after it. name: its row in the statistics.
  virtual void begin() = 0;
  virtual void end(const std::string& name) = 0;
};

// Null for none. To be changed while no session renders.
inline std::atomic<StageObserver*> stageObserver{nullptr};

}  // namespace wavecrest
