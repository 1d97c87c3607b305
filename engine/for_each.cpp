#include "engine/for_each.h"

#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

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
  // The graph has a token for each i. One that had its turn goes back to the queue; the run ends when none is put back.
  namespace flow = oneapi::tbb::flow;
  std::vector<char> tokens(count);  // their addresses count
  TaskRecorder::Step step(count, true);
  TaskOrder order;
  flow::graph graph;
  flow::queue_node<size_t> ready(graph);
  const auto task = [&](size_t i) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    const TaskRecorder::Task recorded(step, i);
    observe(&tokens[i]);
    const bool again = turn(i);
    publish(&tokens[i]);
    if (again) ready.try_put(i);
    return flow::continue_msg();
  };
  flow::function_node<size_t, flow::continue_msg, flow::rejecting> running(graph, threads, task);
  flow::make_edge(ready, running);
  for (size_t i = 0; i < count; ++i) ready.try_put(i);
  graph.wait_for_all();
  order.wait();
}

}  // namespace wavecrest
