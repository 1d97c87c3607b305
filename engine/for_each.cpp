#include "engine/for_each.h"

#include <oneapi/tbb/concurrent_queue.h>
#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include <algorithm>
#include <vector>

#include "engine/task_order.h"
#include "engine/task_recorder.h"

namespace wavecrest {

void forEach(size_t count, const std::function<void(size_t)>& body) {
  TaskRecorder::Step step(count);
  TaskOrder order;
  const auto task = [&](size_t i) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    const TaskRecorder::Task recorded(step, i);
    body(i);
  };
  oneapi::tbb::parallel_for(size_t{0}, count, task, oneapi::tbb::simple_partitioner());
  order.wait();
}

void takeTurns(size_t count, size_t threads, const std::function<bool(size_t)>& turn) {
  // A queue has a token for each i; one that had its turn goes back to its end. The graph has a message for each
  // thread, which takes the next token whenever it comes. So a message that waits for a thread that is late keeps no i
  // waiting.
  namespace flow = oneapi::tbb::flow;
  std::vector<char> tokens(count);  // their addresses count
  TaskRecorder::Step step(count, true);
  TaskOrder order;
  oneapi::tbb::concurrent_queue<size_t> ready;
  for (size_t i = 0; i < count; ++i) ready.push(i);
  flow::graph graph;
  flow::function_node<size_t>* next = nullptr;
  const auto task = [&](size_t message) WAVECREST_TASK_ENTRY {
    size_t i = 0;
    if (!ready.try_pop(i)) return flow::continue_msg();  // others have what is left
    {
      const TaskOrder::Task scope(order);
      const TaskRecorder::Task recorded(step, i);
      observe(&tokens[i]);
      const bool again = turn(i);
      publish(&tokens[i]);
      if (again) ready.push(i);
    }
    next->try_put(message);
    return flow::continue_msg();
  };
  flow::function_node<size_t> running(graph, threads, task);
  next = &running;
  for (size_t message = 0; message < std::min(count, threads); ++message) running.try_put(message);
  graph.wait_for_all();
  order.wait();
}

}  // namespace wavecrest
