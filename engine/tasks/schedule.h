// Phases of a render's iterations, and in which order their tasks are handed out.
//
// A schedule is data: the phases of one iteration, each with a number of tasks that may run side by side, and what a
// phase waits for. Iterations overlap where the waits allow it: while the last tasks of one iteration run, threads
// without work begin the next. ScheduleState is the policy. The render (run_schedule.h) and the prediction for other
// numbers of threads (bench/scaling/list_schedule.h) both hand out tasks by it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

namespace wavecrest {

// Phase `phase` of an iteration begins once phase `on` of the iteration `earlier` before is over, apart from its first
// `ahead` tasks, which do not wait. sameTask: instead, each task begins once the task of the same index is over, and
// those before that; both phases have as many tasks.
struct ScheduleWait {
  size_t phase = 0, on = 0;
  uint64_t earlier = 0;
  size_t ahead = 0;
  bool sameTask = false;
};

struct Schedule {
  std::vector<size_t> tasks;        // of each phase, at least one
  std::vector<ScheduleWait> waits;  // besides these, a phase waits for the one before it

  size_t taskCount() const;
};

struct ScheduledTask {
  uint64_t iteration = 0;
  size_t phase = 0, index = 0;
};

// Which tasks have begun and which are over. Not safe from several threads.
class ScheduleState {
 public:
  // Whether another iteration may begin while `underWay` of them have begun and are not over.
  using MayBegin = std::function<bool(uint64_t iteration, size_t underWay)>;

  ScheduleState(const Schedule& schedule, uint64_t firstIteration) : schedule_(schedule), first_(firstIteration) {}

  // The next task: of the oldest iteration that has one, in the order of phases and of their tasks. Asks mayBegin only
  // where the iterations under way have none. Nothing if there is none now.
  std::optional<ScheduledTask> take(const MayBegin& mayBegin);
  // The task is over.
  void end(const ScheduledTask& task);
  // Iterations before this one are over.
  uint64_t firstUnderWay() const { return first_; }

 private:
  struct Phase {
    size_t taken = 0, over = 0;  // tasks
    size_t first = 0;            // tasks before this one are over
    std::vector<bool> isOver;
  };
  struct Iteration {
    std::vector<Phase> phases;
    size_t next = 0;  // the first phase of which not all tasks are taken: no later one can begin
  };
  // nullptr: of an iteration that has not begun.
  const Phase* phaseOf(uint64_t iteration, size_t phase) const;
  bool isOver(uint64_t iteration, size_t phase) const;
  // How many more tasks of a phase may be taken now; taken: how many were.
  size_t readyOf(uint64_t iteration, size_t phase, size_t taken) const;
  // How many tasks of the iteration at this place of begun_ may be taken now.
  size_t readyAt(uint64_t place) const;

  Schedule schedule_;
  uint64_t first_;
  std::deque<Iteration> begun_;
};

}  // namespace wavecrest
