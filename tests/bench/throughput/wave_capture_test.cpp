// Waves from all over the film are all of its waves.
#include "bench/throughput/wave_capture.h"

#include <gtest/gtest.h>

#include <set>

namespace wavecrest {
namespace {

TEST(WaveCapture, spreadIndicesAreAllOfThem) {
  for (size_t count = 1; count <= 100; ++count) {
    std::set<size_t> met;
    for (size_t i = 0; i < count; ++i) met.insert(spreadIndex(i, count));
    EXPECT_EQ(met.size(), count);
    EXPECT_LT(*met.rbegin(), count);
  }
}

}  // namespace
}  // namespace wavecrest
