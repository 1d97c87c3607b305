#include "engine/tasks/for_each.h"

#include <oneapi/tbb/concurrent_queue.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

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

// Each i waits in a queue for its turn, and goes back to the end of it after the turn. A worker that finds the queue
// empty ends: each i that is left is in the hands of another worker, which goes on with it. An exception ends all
// workers after the turns under way; the first one is thrown on.
void takeTurns(size_t count, size_t threads, const std::function<bool(size_t)>& turn) {
  TaskRecorder::Step step(count, true);
  std::vector<char> tokens(count);  // their addresses count
  oneapi::tbb::concurrent_queue<size_t> queue;
  for (size_t i = 0; i < count; ++i) queue.push(i);
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  const auto takeOne = [&](size_t i) {
    const TaskRecorder::Task recorded(step, i);
    // The turns of one i follow each other, which ThreadSanitizer cannot see.
    observe(&tokens[i]);
    const bool again = turn(i);
    publish(&tokens[i]);
    return again;
  };
  TaskOrder order;
  const auto work = [&](size_t) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    try {
      for (size_t i = 0; !failed && queue.try_pop(i);) {
        if (takeOne(i)) queue.push(i);
      }
    } catch (...) {
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  // Workers beyond the number of turns would find the queue empty.
  oneapi::tbb::parallel_for(size_t{0}, std::min(count, threads), work, oneapi::tbb::simple_partitioner());
  order.wait();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace wavecrest
