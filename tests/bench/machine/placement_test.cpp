// Where threads go on machines that hwloc makes up, and that a session's threads are where they were put.
#include "bench/machine/placement.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>
#include <sched.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "engine/tasks/thread_pins.h"

namespace wavecrest {
namespace {

// How many threads each core and each node got; no hardware thread comes twice, and all are usable ones.
struct Load {
  std::map<uint32_t, size_t> cores, nodes;
};
Load loadOf(const std::vector<HardwareThread>& usable, const Placement& placement) {
  Load load;
  std::set<uint32_t> seen;
  for (const uint32_t cpu : placement.cpus) {
    EXPECT_TRUE(seen.insert(cpu).second) << cpu;
    const auto found =
        std::find_if(usable.begin(), usable.end(), [&](const HardwareThread& each) { return each.cpu == cpu; });
    if (found == usable.end()) {
      ADD_FAILURE() << cpu << " is not usable";
      continue;
    }
    ++load.cores[found->core];
    ++load.nodes[found->node];
  }
  return load;
}
size_t most(const std::map<uint32_t, size_t>& counts) {
  size_t most = 0;
  for (const auto& [index, count] : counts) most = std::max(most, count);
  return most;
}

const char* const kTwoSockets = "package:2 numa:1 core:56 pu:2";
const char* const kFourNodesASocket = "package:2 numa:4 core:14 pu:2";

TEST(Placement, threadsThatFitStayOnOneNode) {
  const auto usable = syntheticHardwareThreads(kTwoSockets);
  const Placement placement = placeThreads(usable, 56).placement;
  ASSERT_EQ(placement.cpus.size(), 56u);
  EXPECT_EQ(placement.nodes, (std::vector<uint32_t>{0}));
  const Load load = loadOf(usable, placement);
  EXPECT_EQ(load.cores.size(), 56u) << "a core each";
}

TEST(Placement, moreThreadsAreSharedEvenlyAmongSockets) {
  const auto usable = syntheticHardwareThreads(kTwoSockets);
  const Placement placement = placeThreads(usable, 64).placement;
  const Load load = loadOf(usable, placement);
  EXPECT_EQ(load.cores.size(), 64u);
  EXPECT_EQ(load.nodes, (std::map<uint32_t, size_t>{{0, 32}, {1, 32}}));
  EXPECT_EQ(placement.nodes, (std::vector<uint32_t>{0, 1}));
}

TEST(Placement, aPartHasTheNodesOfItsThreads) {
  const auto usable = syntheticHardwareThreads(kTwoSockets);
  const Placement whole = placeThreads(usable, 112).placement;
  const Placement first = partOf(whole, usable, 0, 1), rest = partOf(whole, usable, 1, 111);
  EXPECT_EQ(first.nodes, (std::vector<uint32_t>{0}));
  EXPECT_EQ(rest.nodes, (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(std::count(rest.cpus.begin(), rest.cpus.end(), first.cpus.front()), 0);
}

TEST(Placement, coresAreSharedOnlyWhereThereAreTooFew) {
  const auto usable = syntheticHardwareThreads(kTwoSockets);
  EXPECT_EQ(most(loadOf(usable, placeThreads(usable, 112).placement).cores), 1u);
  const Load load = loadOf(usable, placeThreads(usable, 120).placement);
  EXPECT_EQ(load.cores.size(), 112u);
  EXPECT_EQ(load.nodes, (std::map<uint32_t, size_t>{{0, 60}, {1, 60}}));
  EXPECT_EQ(placeThreads(usable, 224).placement.cpus.size(), 224u);
}

TEST(Placement, asFewNodesOfASocketAsHaveCoresEnough) {
  const auto usable = syntheticHardwareThreads(kFourNodesASocket);
  EXPECT_EQ(placeThreads(usable, 14).placement.nodes.size(), 1u);
  EXPECT_EQ(placeThreads(usable, 15).placement.nodes.size(), 2u);
  const Placement all = placeThreads(usable, 64).placement;
  EXPECT_EQ(all.nodes.size(), 5u);
  EXPECT_EQ(most(loadOf(usable, all).nodes), 13u) << "13 on four, 12 on one";
}

TEST(Placement, aMachineOfOneNodeHasNothingToSpread) {
  const auto usable = syntheticHardwareThreads("package:1 numa:1 core:8 pu:1");
  const Placement placement = placeThreads(usable, 8).placement;
  EXPECT_EQ(placement.cpus, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(placement.nodes, (std::vector<uint32_t>{0}));
}

// Hardware threads 0 and 1 are core 0's: the mask leaves one core half, takes one out and leaves another whole.
TEST(Placement, keepsToAnOddMask) {
  const auto usable = syntheticHardwareThreads("package:1 numa:1 core:4 pu:2", "1,4-5,7");
  EXPECT_EQ(placeThreads(usable, 3).placement.cpus, (std::vector<uint32_t>{1, 4, 7}));
  EXPECT_EQ(placeThreads(usable, 4).placement.cpus, (std::vector<uint32_t>{1, 4, 7, 5}));
}

// A control group that leaves two cores of one socket and six of the other.
TEST(Placement, nodesWithFewCoresGetNoMoreThanThese) {
  const auto usable = syntheticHardwareThreads("package:2 numa:1 core:8 pu:1", "0-1,8-13");
  EXPECT_EQ(placeThreads(usable, 6).placement.cpus, (std::vector<uint32_t>{8, 9, 10, 11, 12, 13}));
  const Load load = loadOf(usable, placeThreads(usable, 8).placement);
  EXPECT_EQ(load.nodes, (std::map<uint32_t, size_t>{{0, 2}, {1, 6}}));
}

TEST(Placement, moreThreadsThanHardwareThreadsAreLeftToTheSystem) {
  const PlacementPlan plan = placeThreads(syntheticHardwareThreads("package:1 numa:1 core:2 pu:1"), 3);
  EXPECT_TRUE(plan.placement.cpus.empty());
  EXPECT_EQ(plan.refusal, "3 threads for 2 hardware threads");
}

// Threads are bound within the arena, and outside of it where they were before.
TEST(ThreadPins, bindThreadsWhileTheyWorkInTheArena) {
  cpu_set_t before, after;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  PlacementPlan plan = placeOnThisMachine(1);
  if (!plan.refusal.empty()) GTEST_SKIP() << plan.refusal;
  oneapi::tbb::task_arena arena(1);
  const ThreadPins pins(arena, plan.placement);
  arena.execute([&] {
    cpu_set_t within;
    ASSERT_EQ(sched_getaffinity(0, sizeof within, &within), 0);
    EXPECT_EQ(CPU_COUNT(&within), 1);
    EXPECT_TRUE(CPU_ISSET(plan.placement.cpus.front(), &within));
  });
  ASSERT_EQ(sched_getaffinity(0, sizeof after, &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

// With pins destroyed while a thread is in the arena, it is unbound all the same.
TEST(ThreadPins, leaveNoThreadBound) {
  cpu_set_t before, after;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  PlacementPlan plan = placeOnThisMachine(1);
  if (!plan.refusal.empty() || CPU_COUNT(&before) == 1) GTEST_SKIP() << plan.refusal;
  oneapi::tbb::task_arena arena(1);
  std::optional<ThreadPins> pins(std::in_place, arena, plan.placement);
  arena.execute([&] { pins.reset(); });
  ASSERT_EQ(sched_getaffinity(0, sizeof after, &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST(ThreadPins, aHardwareThreadThatIsNotThereIsRefused) { EXPECT_FALSE(bindThread(1'000'000)); }

}  // namespace
}  // namespace wavecrest
