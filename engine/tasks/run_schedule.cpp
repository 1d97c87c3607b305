#include "engine/tasks/run_schedule.h"

#include <oneapi/tbb/flow_graph.h>

#include <atomic>
#include <deque>
#include <exception>

#include "engine/tasks/task_order.h"
#include "engine/tasks/task_recorder.h"

namespace wavecrest {
namespace {

namespace flow = oneapi::tbb::flow;

// A task that is over, or nothing: the message that starts the graph.
struct Ended {
  std::optional<ScheduledTask> task = std::nullopt;
  double seconds = 0;  // if the render is recorded
};

class ScheduleGraph {
 public:
  using Run = std::function<void(const ScheduledTask&)>;

  ScheduleGraph(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                const ScheduleState::MayBegin& mayBegin, const Run& run)
      : threads_(threads),
        mayBegin_(mayBegin),
        run_(run),
        state_(schedule, firstIteration),
        recorded_(schedule, firstIteration),
        barriers_(graph_, flow::serial, [this](const Ended& ended) noexcept WAVECREST_TASK_ENTRY {
          handOut(ended);
          return flow::continue_msg();
        }) {
    for (size_t phase = 0; phase < schedule.tasks.size(); ++phase) {
      phases_.emplace_back(graph_, flow::unlimited, [this](const ScheduledTask& task) noexcept WAVECREST_TASK_ENTRY {
        runTask(task);
        return flow::continue_msg();
      });
    }
  }

  // Returns the first iteration that did not begin.
  uint64_t runAll() {
    barriers_.try_put({});
    graph_.wait_for_all();
    order_.wait();
    if (failure_) std::rethrow_exception(failure_);
    return state_.firstUnderWay();
  }

 private:
  // The node of a phase: runs a task, a copy of the message, and reports its end to the barriers.
  void runTask(ScheduledTask task) noexcept {
    const TaskOrder::Task scope(order_);
    observe(&phases_);
    Ended ended{.task = task};
    try {
      if (!recorded_.records()) {
        run_(task);
      } else {
        const auto begin = TaskRecorder::Clock::now();
        run_(task);
        ended.seconds = std::chrono::duration<double>(TaskRecorder::Clock::now() - begin).count();
      }
    } catch (...) {
      fail();
    }
    publish(&barriers_);
    barriers_.try_put(ended);
  }
  // The node of the barriers: one message at a time. Hands out tasks as long as there are threads for them.
  void handOut(const Ended& ended) noexcept {
    observe(&barriers_);
    if (ended.task) {
      state_.end(*ended.task);
      recorded_.add(*ended.task, ended.seconds);
      --running_;
    }
    try {
      while (running_ < threads_ && !failed_) {
        const std::optional<ScheduledTask> task = state_.take(mayBegin_);
        if (!task) break;
        ++running_;
        publish(&phases_);
        phases_[task->phase].try_put(*task);
      }
    } catch (...) {
      fail();
    }
    publish(&barriers_);
  }
  // Keeps the first exception.
  void fail() noexcept {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }

  const size_t threads_;
  const ScheduleState::MayBegin& mayBegin_;
  const Run& run_;
  size_t running_ = 0;
  ScheduleState state_;
  TaskRecorder::Iterations recorded_;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  TaskOrder order_;
  flow::graph graph_;
  flow::function_node<Ended, flow::continue_msg, flow::queueing_lightweight> barriers_;
  std::deque<flow::function_node<ScheduledTask>> phases_;
};

}  // namespace

uint64_t runSchedule(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                     const ScheduleState::MayBegin& mayBegin, const std::function<void(const ScheduledTask&)>& run) {
  return ScheduleGraph(schedule, firstIteration, threads, mayBegin, run).runAll();
}

}  // namespace wavecrest
