// Work, span and schedules of graphs that can be worked out by hand.
#include "bench/scaling/list_schedule.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

TaskStep independent(const std::vector<double>& tasks) {
  TaskStep step;
  for (const double task : tasks) step.chains.push_back({task});
  return step;
}

TaskGraph withEnds(std::vector<TaskStep> steps) {
  TaskGraph graph{std::move(steps)};
  graph.steps.insert(graph.steps.begin(), independent({0.5}));
  graph.steps.push_back(independent({0.25}));
  return graph;
}

TEST(ListSchedule, aTaskGoesToTheThreadThatIsFreeFirst) {
  const TaskGraph graph{{independent({3, 1, 1, 2, 2})}};
  EXPECT_DOUBLE_EQ(workOf(graph), 9);
  EXPECT_DOUBLE_EQ(spanOf(graph), 3);
  EXPECT_EQ(taskCount(graph), 5u);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 1), 9);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 5);  // 3 2 | 1 1 2
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 3), 3);  // 3 | 1 2 | 1 2
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 64), 3);
}

TEST(ListSchedule, stepsWaitForEachOther) {
  const TaskGraph graph{{independent({1, 1, 1}), independent({2}), independent({1, 1, 1})}};
  EXPECT_DOUBLE_EQ(spanOf(graph), 4);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 6);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 64), 4);
}

TEST(ListSchedule, tasksOfAChainFollowOneAnotherAndChainsTakeTurns) {
  const TaskGraph graph{{{.chains = {{1, 1, 1}, {2, 2}, {1}}}}};
  EXPECT_DOUBLE_EQ(workOf(graph), 8);
  EXPECT_DOUBLE_EQ(spanOf(graph), 4);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 1), 8);
  // One thread takes the first chain, the third and the first again, the other the second chain; then one task each.
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 4);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 3), 4);
}

TEST(ListSchedule, aLongerRenderRepeatsWhatIsBetweenItsEnds) {
  const TaskGraph graph = withEnds({independent({1, 1, 1}), independent({2})});
  EXPECT_DOUBLE_EQ(workOf(graph, 10), 0.75 + 50);
  EXPECT_DOUBLE_EQ(spanOf(graph, 10), 0.75 + 30);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2, 10), 0.75 + 40);
}

TEST(ListSchedule, waitsOfALongerRenderAreNoLongerWhereItGoesOn) {
  TaskStep step = independent({1, 1, 1});
  step.goesOn = true;
  const TaskGraph graph = withEnds({step});
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 0.75 + 2);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2, 10), 0.75 + 15);  // 30 tasks, without a barrier between
  EXPECT_DOUBLE_EQ(spanOf(graph, 10), 0.75 + 10);
}

// Two light tasks, a map, two camera tasks; one light task may run beside the camera tasks of the iteration before.
TaskStep iterations(size_t count, const std::vector<double>& tasks, size_t ahead) {
  return {.chains = std::vector(count, tasks),
          .goesOn = true,
          .schedule = Schedule{.tasks = {2, 1, 2},
                               .waits = {{.phase = 0, .on = 2, .earlier = 1, .ahead = ahead},
                                         {.phase = 0, .on = 2, .earlier = 2},
                                         {.phase = 1, .on = 2, .earlier = 1}}}};
}

TEST(ListSchedule, phasesWaitForEachOther) {
  const TaskGraph graph{{iterations(3, {2, 1, 1, 4, 2}, 0)}};
  EXPECT_DOUBLE_EQ(workOf(graph), 30);
  EXPECT_DOUBLE_EQ(spanOf(graph), 3 * 7);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 1), 30);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 3 * 7);
}

TEST(ListSchedule, theNextIterationFillsTheEndOfAPhase) {
  const TaskGraph graph{{iterations(3, {2, 1, 1, 4, 2}, 1)}};
  // One thread has light 2, map 1, camera 4; the other light 1, the first light task of the next iteration, camera 2.
  // From then on an iteration has light 1, map 1, camera 4 on one thread.
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2), 7 + 6 + 6);
  EXPECT_DOUBLE_EQ(scheduledSeconds(graph, 2, 10), 7 + 29 * 6);
  EXPECT_DOUBLE_EQ(workOf(graph, 10), 300);
}

}  // namespace
}  // namespace wavecrest
