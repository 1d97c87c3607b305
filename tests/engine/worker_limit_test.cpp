// Sessions at work do not take cores from each other, and have threads beyond the number of cores.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include "engine/session/render_clock.h"

namespace wavecrest {
namespace {

size_t allowedThreads() {
  return oneapi::tbb::global_control::active_value(oneapi::tbb::global_control::max_allowed_parallelism);
}

size_t cores() { return static_cast<size_t>(oneapi::tbb::info::default_concurrency()); }

TEST(WorkerLimit, ofOneThreadLeavesTheCoresToOthers) {
  const WorkerLimit one(1);
  EXPECT_GE(allowedThreads(), cores());
}

TEST(WorkerLimit, allowsMoreThreadsThanCores) {
  const WorkerLimit more(cores() + 2);
  EXPECT_EQ(allowedThreads(), cores() + 2);
}

}  // namespace
}  // namespace wavecrest
