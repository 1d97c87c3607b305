// What a recorder keeps of a render: all of its time, and its tasks as the work was cut.
#include "engine/task_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/scaling/list_schedule.h"
#include "engine/for_each.h"
#include "engine/load/load.h"
#include "engine/session.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

TaskGraph recorded(Method method, uint32_t threads, uint32_t cutFor, double& seconds) {
  LoadOptions options;
  options.filmSize = {96, 64};
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.method = method;
  settings.threads = threads;
  settings.piecesForThreads = cutFor;
  const auto session = Session::create(loadScene(findScene("cornell-diffuse"), options), settings);
  session->renderUntil(2, std::nullopt);
  const double before = session->statistics().renderSeconds;
  TaskRecorder recorder;
  session->renderUntil(6, std::nullopt);
  TaskGraph graph = recorder.graph();
  seconds = session->statistics().renderSeconds - before;
  return graph;
}

TEST(TaskRecorder, accountsForAllTimeOfARenderOnOneThread) {
  for (const Method method : {Method::pt, Method::bpt, Method::vcm, Method::mlt}) {
    double seconds = 0;
    const TaskGraph graph = recorded(method, 1, 1, seconds);
    EXPECT_GE(workOf(graph), seconds) << toString(method);
    EXPECT_NEAR(workOf(graph), seconds, 0.05 * seconds + 2e-3) << toString(method);
    EXPECT_NEAR(scheduledSeconds(graph, 1), workOf(graph), 1e-9) << toString(method);
  }
}

TEST(TaskRecorder, keepsTheOrderOfPhases) {
  double seconds = 0;
  const TaskGraph graph = recorded(Method::vcm, 2, 2, seconds);
  // Each of four iterations has light walks, the steps of the photon map and camera walks, and none goes on by itself.
  const auto wide = std::count_if(graph.steps.begin(), graph.steps.end(),
                                  [](const TaskStep& step) { return step.chains.size() > 1; });
  EXPECT_GE(wide, 4 * 2);
  EXPECT_TRUE(std::none_of(graph.steps.begin(), graph.steps.end(), [](const TaskStep& step) { return step.goesOn; }));

  const TaskGraph waves = recorded(Method::bpt, 2, 2, seconds);
  const auto going =
      std::find_if(waves.steps.begin(), waves.steps.end(), [](const TaskStep& step) { return step.goesOn; });
  ASSERT_NE(going, waves.steps.end());
  for (const auto& chain : going->chains) EXPECT_EQ(chain.size(), 4u) << "a task for each iteration";
}

TEST(TaskRecorder, workIsCutForTheThreadsInQuestion) {
  double seconds = 0;
  const size_t forOne = taskCount(recorded(Method::bpt, 1, 1, seconds));
  const size_t forMany = taskCount(recorded(Method::bpt, 1, 16, seconds));
  EXPECT_GE(forMany, 8 * forOne);
}

TEST(TaskRecorder, stepsWithinTasksBelongToThem) {
  TaskRecorder recorder;
  forEach(3, [](size_t) { forEach(5, [](size_t) {}); });
  const TaskGraph graph = recorder.graph();
  ASSERT_EQ(graph.steps.size(), 3u);  // before, the tasks, after
  EXPECT_EQ(graph.steps[1].chains.size(), 3u);
}

TEST(TaskRecorder, nothingIsKeptWithoutOne) {
  forEach(3, [](size_t) {});
  TaskRecorder recorder;
  EXPECT_EQ(recorder.graph().steps.size(), 1u);
}

}  // namespace
}  // namespace wavecrest
