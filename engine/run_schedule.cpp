#include "engine/run_schedule.h"

#include <oneapi/tbb/flow_graph.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "engine/task_order.h"
#include "engine/task_recorder.h"

namespace wavecrest {
namespace {

// The state with its lock, and the threads that wait for tasks.
class Dispatcher {
 public:
  Dispatcher(const Schedule& schedule, uint64_t firstIteration, const ScheduleState::MayBegin& mayBegin)
      : state_(schedule, firstIteration), mayBegin_(mayBegin), recorded_(schedule, firstIteration) {}

  // Ends a task, if any, and takes the next. Without a next one the caller's thread counts as waiting. `wake`: how many
  // of the waiting threads are to come for tasks; they no longer count.
  std::optional<ScheduledTask> next(const std::optional<ScheduledTask>& done, double seconds, size_t& wake) {
    const std::lock_guard lock(mutex_);
    if (done) {
      state_.end(*done);
      recorded_.add(*done, seconds);
    }
    const std::optional<ScheduledTask> task = state_.take(mayBegin_);
    wake = task ? std::min(waiting_, state_.ready()) : 0;
    waiting_ -= wake;
    if (!task) ++waiting_;
    return task;
  }
  uint64_t firstUnderWay() const { return state_.firstUnderWay(); }
  bool records() const { return recorded_.records(); }

 private:
  std::mutex mutex_;
  ScheduleState state_;
  const ScheduleState::MayBegin& mayBegin_;
  size_t waiting_ = 0;
  TaskRecorder::Iterations recorded_;
};

}  // namespace

uint64_t runSchedule(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                     const ScheduleState::MayBegin& mayBegin, const std::function<void(const ScheduledTask&)>& run) {
  // The graph has a message for each thread that works. A message takes tasks until there is none, and ends. Whoever
  // makes others ready sends messages for the threads that wait.
  namespace flow = oneapi::tbb::flow;
  TaskOrder order;
  Dispatcher dispatcher(schedule, firstIteration, mayBegin);
  flow::graph graph;
  flow::function_node<size_t>* workers = nullptr;
  const auto work = [&](size_t message) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    std::optional<ScheduledTask> task;
    double seconds = 0;
    for (;;) {
      size_t wake = 0;
      task = dispatcher.next(task, seconds, wake);
      for (; wake != 0; --wake) workers->try_put(message);
      if (!task) return flow::continue_msg();
      if (!dispatcher.records()) {
        run(*task);
        continue;
      }
      const auto begin = TaskRecorder::Clock::now();
      run(*task);
      seconds = std::chrono::duration<double>(TaskRecorder::Clock::now() - begin).count();
    }
  };
  flow::function_node<size_t> running(graph, threads, work);
  workers = &running;
  for (size_t message = 0; message < threads; ++message) running.try_put(message);
  graph.wait_for_all();
  order.wait();
  return dispatcher.firstUnderWay();
}

}  // namespace wavecrest
