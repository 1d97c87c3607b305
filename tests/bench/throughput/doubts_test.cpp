// Figures that deserve doubt get it, others do not.
#include "bench/throughput/doubts.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

Estimate within(double value, double part) { return {value, {value * (1 - part), value * (1 + part)}}; }

// As measured on a quiet machine with one and two threads: one visit of fifteen slices, whose CPU times differ by at
// most 1.4 %.
Speed quietSpeed() {
  std::vector<Slice> slices(15);
  for (size_t i = 0; i < slices.size(); ++i) {
    slices[i] = {.seconds = 0.1,
                 .cpuSeconds = 0.1 + 1e-4 * static_cast<double>(i),
                 .paths = 100000,
                 .counters = {},
                 .stages = {}};
  }
  Speed speed;
  speed.pathsPerSecond = within(2e6, 0.01);
  speed.pathsPerCpuSecond = within(1e6, 0.01);
  speed.scaling = {{1, within(1e6, 0.01), within(1, 0), within(1, 0), {slices}},
                   {2, within(2e6, 0.01), within(1.97, 0.01), within(0.99, 0.01), {slices}}};
  return speed;
}

TEST(Doubts, aQuietMeasurementHasNone) { EXPECT_TRUE(doubtsAbout(quietSpeed()).empty()); }

TEST(Doubts, tooShortARunSaysSo) {
  Speed speed = quietSpeed();
  speed.pathsPerCpuSecond = within(1e6, 0.1);
  const auto doubts = doubtsAbout(speed);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].find("10 % only"), std::string::npos);
  EXPECT_NE(doubts[0].find("4 times the duration"), std::string::npos);
}

TEST(Doubts, unevenSlicesAreNamed) {
  Speed speed = quietSpeed();
  for (size_t i = 0; i < 15; i += 2) speed.scaling[1].slices[0][i].cpuSeconds *= 1.3;
  const auto doubts = doubtsAbout(speed);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].find("on 2 threads differ"), std::string::npos);
}

TEST(Doubts, anEfficiencyAbove105PercentCannotBe) {
  Speed speed = quietSpeed();
  speed.scaling[1].speedup.value = 2.11;
  EXPECT_EQ(doubtsAbout(speed).size(), 1u);
  speed.scaling[1].speedup.value = 2.09;
  EXPECT_TRUE(doubtsAbout(speed).empty());
  speed.scaling[1].cpuEfficiency.value = 1.06;
  EXPECT_EQ(doubtsAbout(speed).size(), 1u);
}

TEST(Doubts, aBusyMachineIsNamed) {
  Speed speed = quietSpeed();
  speed.machine.othersCores = 1;
  EXPECT_EQ(doubtsAbout(speed).size(), 1u);
}

}  // namespace
}  // namespace wavecrest
