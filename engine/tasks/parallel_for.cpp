#include "engine/tasks/parallel_for.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#include "engine/tasks/task_order.h"

namespace wavecrest {

void parallelFor(size_t count, const std::function<void(size_t)>& body) {
  TaskOrder order;
  const auto task = [&](size_t i) WAVECREST_TASK_ENTRY {
    const TaskOrder::Task scope(order);
    body(i);
  };
  oneapi::tbb::parallel_for(size_t{0}, count, task, oneapi::tbb::simple_partitioner());
  order.wait();
}

}  // namespace wavecrest
