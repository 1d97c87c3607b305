// Speeds of few rounds have no interval: the range of one is a point.
#include "bench/throughput/policies.h"

#include <gtest/gtest.h>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

TEST(Policies, fewRoundsHaveNoInterval) {
  const PolicyTable table = measurePolicies(smallBox(16, 12), settingsOf(Method::pt), 1e-4);
  ASSERT_FALSE(table.rows.empty());
  for (const PolicyRow& row : table.rows) {
    EXPECT_GT(row.pathsPerCpuSecond, 0) << toString(row.isa);
    EXPECT_FALSE(row.pathsPerCpuSecondInterval.has_value()) << toString(row.isa);
  }
}

}  // namespace
}  // namespace wavecrest
