// Threads that take tasks from a policy, on a TBB flow graph.
#pragma once

#include <oneapi/tbb/flow_graph.h>

#include <optional>

#include "engine/tasks/task_order.h"

namespace wavecrest {

// Runs a policy's tasks on the current arena's threads, at most `threads` at a time, and returns when none is left.
//
// A message of the graph stands for a worker: it runs one task after the other, and ends when the policy has none for
// it. When the end of a task makes others ready, new messages start workers for them. Tasks belong to no worker, so no
// task waits for a thread that comes late.
//
// A Policy defines a type Task and two functions. Several threads may call them at once.
//   size_t next(std::optional<Task>& task)  Ends `task` if it holds one. Puts the next task there, or nothing if none
//   is
//                                           ready. Returns how many workers to start.
//   void run(Task& task)                    Does the work.
// An exception from either stops the other workers, and is thrown on.
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
