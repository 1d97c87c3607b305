#include "engine/tasks/for_each.h"

#include <oneapi/tbb/concurrent_queue.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/tasks/run_tasks.h"
#include "engine/tasks/task_order.h"
#include "engine/tasks/task_recorder.h"

namespace wavecrest {

void forEach(size_t count, const std::function<void(size_t)>& body) {
  TaskRecorder::Step step(count);
  TaskOrder order;
  const auto task = [&](size_t i) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    const TaskRecorder::Task recorded(step, i);
    body(i);
  };
  // With this partitioner each i is a task of its own.
  oneapi::tbb::parallel_for(size_t{0}, count, task, oneapi::tbb::simple_partitioner());
  order.wait();
}

namespace {

// Each i waits in a queue for its turn, and goes back to the end of it after the turn. A worker that finds the queue
// empty ends: each i that is left is in the hands of another worker, which goes on with it.
class Turns {
 public:
  struct Task {
    size_t i = 0;
    bool again = false;
  };

  Turns(size_t count, const std::function<bool(size_t)>& turn) : turn_(turn), tokens_(count), recorded_(count, true) {
    for (size_t i = 0; i < count; ++i) queue_.push(i);
  }

  // Returns 0 to runTasks: no further worker has to be started for the turns that are left.
  size_t next(std::optional<Task>& task) {
    if (task && task->again) queue_.push(task->i);
    task.reset();
    if (size_t i = 0; queue_.try_pop(i)) task = Task{.i = i};
    return 0;
  }
  void run(Task& task) {
    const TaskRecorder::Task recorded(recorded_, task.i);
    // The turns of one i follow each other, which ThreadSanitizer cannot see.
    observe(&tokens_[task.i]);
    task.again = turn_(task.i);
    publish(&tokens_[task.i]);
  }

 private:
  const std::function<bool(size_t)>& turn_;
  std::vector<char> tokens_;  // their addresses count
  TaskRecorder::Step recorded_;
  oneapi::tbb::concurrent_queue<size_t> queue_;
};

}  // namespace

void takeTurns(size_t count, size_t threads, const std::function<bool(size_t)>& turn) {
  Turns turns(count, turn);
  // Workers beyond the number of turns would find the queue empty.
  runTasks(turns, std::min(count, threads));
}

}  // namespace wavecrest
