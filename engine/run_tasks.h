// Threads that take tasks from a policy, on a TBB flow graph.
#pragma once

#include <oneapi/tbb/flow_graph.h>

#include <optional>

#include "engine/task_order.h"

namespace wavecrest {

// Runs a policy's tasks on the current arena's threads, at most `threads` at a time, and returns when none is left.
//
// The graph has a message for each thread that works. A message takes tasks until there is none for it, and ends; so
// one that waits for a thread that is late keeps no task waiting. Whoever makes others ready sends messages for the
// threads that went without. A Policy has a type Task and, both safe from several threads at once,
//   size_t next(std::optional<Task>& task)  ends the task, if there is one, and takes the next, or nothing; returns for
//                                           how many threads that went without there are tasks now
//   void run(Task& task)
// An exception of either ends the tasks and is thrown on.
template <class Policy>
void runTasks(Policy& policy, size_t threads) {
  namespace flow = oneapi::tbb::flow;
  TaskOrder order;
  flow::graph graph;
  flow::function_node<size_t>* workers = nullptr;
  const auto work = [&](size_t message) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    std::optional<typename Policy::Task> task;
    for (;;) {
      for (size_t wake = policy.next(task); wake != 0; --wake) workers->try_put(message);
      if (!task) return flow::continue_msg();
      policy.run(*task);
    }
  };
  flow::function_node<size_t> running(graph, threads, work);
  workers = &running;
  for (size_t message = 0; message < threads; ++message) running.try_put(message);
  graph.wait_for_all();
  order.wait();
}

}  // namespace wavecrest
