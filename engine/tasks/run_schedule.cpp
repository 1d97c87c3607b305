#include "engine/tasks/run_schedule.h"

#include <algorithm>
#include <mutex>

#include "engine/tasks/run_tasks.h"
#include "engine/tasks/task_recorder.h"

namespace wavecrest {
namespace {

// The state of a schedule behind a lock. Counts the workers that found no task and ended.
class Dispatcher {
 public:
  struct Task {
    ScheduledTask scheduled;
    double seconds = 0;  // if the render is recorded
  };
  using Run = std::function<void(const ScheduledTask&)>;

  Dispatcher(const Schedule& schedule, uint64_t firstIteration, const ScheduleState::MayBegin& mayBegin, const Run& run)
      : state_(schedule, firstIteration), mayBegin_(mayBegin), run_(run), recorded_(schedule, firstIteration) {}

  // Ends the task and takes the next one. Returns how many workers runTasks is to start.
  size_t next(std::optional<Task>& task) {
    const std::lock_guard lock(mutex_);
    // Report the task that the worker has run.
    if (task) {
      state_.end(task->scheduled);
      recorded_.add(task->scheduled, task->seconds);
      task.reset();
    }
    // Take the next task. A worker that finds none ends.
    const std::optional<ScheduledTask> taken = state_.take(mayBegin_);
    if (!taken) {
      ++waiting_;
      return 0;
    }
    task = Task{.scheduled = *taken};
    // Start a worker for each ready task, as long as there are workers that have ended.
    const size_t wake = std::min(waiting_, state_.ready());
    waiting_ -= wake;
    return wake;
  }
  // Runs the task, and measures its time if the render is recorded.
  void run(Task& task) const {
    if (!recorded_.records()) return run_(task.scheduled);
    const auto begin = TaskRecorder::Clock::now();
    run_(task.scheduled);
    task.seconds = std::chrono::duration<double>(TaskRecorder::Clock::now() - begin).count();
  }
  uint64_t firstUnderWay() const { return state_.firstUnderWay(); }

 private:
  std::mutex mutex_;
  ScheduleState state_;
  const ScheduleState::MayBegin& mayBegin_;
  const Run& run_;
  size_t waiting_ = 0;
  TaskRecorder::Iterations recorded_;
};

}  // namespace

uint64_t runSchedule(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                     const ScheduleState::MayBegin& mayBegin, const std::function<void(const ScheduledTask&)>& run) {
  Dispatcher dispatcher(schedule, firstIteration, mayBegin, run);
  runTasks(dispatcher, threads);
  return dispatcher.firstUnderWay();
}

}  // namespace wavecrest
