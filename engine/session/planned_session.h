// What sessions of all schedules have: threads, a film, a plan of the render, clocks and counts.
#pragma once

#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "engine/plan/render_plan.h"
#include "engine/session/method_choice.h"
#include "engine/session/render_clock.h"
#include "engine/session/session.h"
#include "engine/session/work_done.h"
#include "engine/tasks/thread_pins.h"

namespace wavecrest {

// What there is before a session is made.
template <class S>
struct Prepared {
  std::shared_ptr<const CompiledScene<S>> scene{};  // as planRender takes it
  std::optional<MethodChoice> choice{};             // that led to settings.method
  double buildSeconds = 0;                          // that making this took
};

// Runs `work`, which makes what a session needs before it renders, with as many threads as the settings allow; new
// pages are spread over the nodes of their placement. Returns the seconds that it took.
double timeBuilding(const RenderSettings& settings, const std::function<void()>& work);

// S is the storage type of the settings' precision.
template <class S>
class PlannedSession : public Session {
 public:
  const Film& film() const override { return film_; }
  const MemoryPlan& memoryPlan() const override { return plan_.memory; }
  double progressSeconds() const override { return clock_.shown(); }
  uint64_t progressPaths() const override { return progressPaths_.load(std::memory_order_relaxed); }

 protected:
  // Compiles the scene, plans the memory and makes the film. The film has no splats yet: a session that needs them adds
  // them. Throws as Session::create does.
  PlannedSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared = {});

  // Calls `rest`, which makes what a schedule needs besides, under the settings' threads and placement of memory; then
  // pins the threads. To be called once, by the constructor of each schedule's session.
  void finishBuilding(const std::function<void()>& rest);

  // Times, what was planned, and the memory of the scene and the film. Counts and stages are each schedule's own.
  RenderStatistics plannedStatistics() const;

  // Takes over clocks and paths from earlier_, which was restored.
  void goOnFromEarlier(uint64_t progressPaths);

  oneapi::tbb::task_arena arena_;
  double buildSeconds_ = 0;
  Film film_;
  const RenderSettings settings_;
  const RenderPlan<S> plan_;
  const std::optional<MethodChoice> choice_;
  WorkDone earlier_;  // of the sessions that this one goes on for
  RenderClock clock_{settings_.clock, settings_.threads};
  std::atomic<uint64_t> progressPaths_{0};

 private:
  std::optional<ThreadPins> pins_;  // once the session is built
};

extern template class PlannedSession<float>;
extern template class PlannedSession<double>;

}  // namespace wavecrest
