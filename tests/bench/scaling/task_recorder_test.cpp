// What a recorder keeps of a render: all of its time, and its tasks as the work was cut.
#include "engine/tasks/task_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/scaling/list_schedule.h"
#include "engine/session/session.h"
#include "engine/tasks/for_each.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

struct Recording {
  TaskGraph graph;
  double seconds = 0;  // of the render
  double around = 0;   // of the render and a little more
};

Recording recorded(Method method, uint32_t threads, uint32_t cutFor) {
  RenderSettings settings = settingsOf(method);
  settings.threads = threads;
  settings.piecesForThreads = cutFor;
  const auto session = Session::create(smallBox(96, 64), settings);
  session->renderUntil(2, std::nullopt);
  const double before = session->statistics().renderSeconds;
  const auto begin = TaskRecorder::Clock::now();
  TaskRecorder recorder;
  session->renderUntil(6, std::nullopt);
  Recording recording{.graph = recorder.graph()};
  recording.around = std::chrono::duration<double>(TaskRecorder::Clock::now() - begin).count();
  recording.seconds = session->statistics().renderSeconds - before;
  return recording;
}

TEST(TaskRecorder, accountsForAllTimeOfARenderOnOneThread) {
  for (const Method method : {Method::pt, Method::bpt, Method::vcm, Method::mlt}) {
    const Recording recording = recorded(method, 1, 1);
    const double work = workOf(recording.graph);
    EXPECT_GE(work, recording.seconds * (1 - 1e-9)) << toString(method);
    EXPECT_LE(work, recording.around * (1 + 1e-9)) << toString(method);
    EXPECT_NEAR(scheduledSeconds(recording.graph, 1), work, 1e-9 * work) << toString(method);
  }
}

TEST(TaskRecorder, keepsTheOrderOfPhases) {
  const TaskGraph graph = recorded(Method::vcm, 2, 2).graph;
  // Four iterations of light walks, the steps of the photon map and camera walks.
  const auto phases = std::find_if(graph.steps.begin(), graph.steps.end(),
                                   [](const TaskStep& step) { return step.schedule.has_value(); });
  ASSERT_NE(phases, graph.steps.end());
  EXPECT_TRUE(phases->goesOn);
  ASSERT_EQ(phases->chains.size(), 4u);
  EXPECT_GE(phases->schedule->tasks.size(), 3u);
  for (const auto& iteration : phases->chains) {
    EXPECT_EQ(iteration.size(), phases->schedule->taskCount());
    EXPECT_GT(std::ranges::min(iteration), 0) << "a task that was not recorded";
  }

  const TaskGraph waves = recorded(Method::bpt, 2, 2).graph;
  const auto going =
      std::find_if(waves.steps.begin(), waves.steps.end(), [](const TaskStep& step) { return step.goesOn; });
  ASSERT_NE(going, waves.steps.end());
  for (const auto& chain : going->chains) EXPECT_EQ(chain.size(), 4u) << "a task for each iteration";
}

TEST(TaskRecorder, workIsCutForTheThreadsInQuestion) {
  const size_t forOne = taskCount(recorded(Method::bpt, 1, 1).graph);
  const size_t forMany = taskCount(recorded(Method::bpt, 1, 16).graph);
  EXPECT_GE(forMany, 6 * forOne);
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
