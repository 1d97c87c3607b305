// Which tasks a schedule hands out, and that they run once each, in an order that its waits allow.
#include "engine/tasks/schedule.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>

#include "engine/tasks/run_schedule.h"

namespace wavecrest {
namespace {

constexpr size_t kLight = 0, kMap = 1, kCamera = 2;

// As of a method with a photon map: `ahead` light tasks may run beside the camera tasks of the iteration before.
Schedule photonSchedule(size_t light, size_t camera, size_t ahead) {
  return {.tasks = {light, 1, camera},
          .waits = {{.phase = kLight, .on = kCamera, .earlier = 1, .ahead = ahead},
                    {.phase = kLight, .on = kCamera, .earlier = 2},
                    {.phase = kMap, .on = kCamera, .earlier = 1}}};
}

ScheduleState::MayBegin upTo(uint64_t end) {
  return [end](uint64_t iteration, size_t) { return iteration < end; };
}

using Name = std::tuple<uint64_t, size_t, size_t>;
Name nameOf(const ScheduledTask& task) { return {task.iteration, task.phase, task.index}; }

TEST(ScheduleState, handsOutPhaseAfterPhase) {
  ScheduleState state(photonSchedule(2, 2, 0), 5);
  std::vector<Name> order;
  while (const auto task = state.take(upTo(7))) {
    order.push_back(nameOf(*task));
    state.end(*task);
  }
  const std::vector<Name> expected{{5, 0, 0}, {5, 0, 1}, {5, 1, 0}, {5, 2, 0}, {5, 2, 1},
                                   {6, 0, 0}, {6, 0, 1}, {6, 1, 0}, {6, 2, 0}, {6, 2, 1}};
  EXPECT_EQ(order, expected);
  EXPECT_EQ(state.firstUnderWay(), 7u);
}

TEST(ScheduleState, nothingIsReadyWhileAPhaseIsNotOver) {
  ScheduleState state(photonSchedule(2, 2, 0), 0);
  const auto first = state.take(upTo(9)), second = state.take(upTo(9));
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(state.take(upTo(9)));
  state.end(*first);
  EXPECT_FALSE(state.take(upTo(9)));
  state.end(*second);
  EXPECT_EQ(state.take(upTo(9))->phase, kMap);
  EXPECT_FALSE(state.take(upTo(9)));
}

// The state with all tasks before the camera's last one over, which is under way.
struct BesideTheLastCameraTask {
  ScheduleState state;
  ScheduledTask last;

  explicit BesideTheLastCameraTask(size_t ahead) : state(photonSchedule(4, 2, ahead), 0) {
    for (size_t i = 0; i < 6; ++i) state.end(*state.take(upTo(9)));
    last = *state.take(upTo(9));
  }
};

TEST(ScheduleState, lightTasksOfTheNextIterationRunBesideTheLastCameraTasks) {
  BesideTheLastCameraTask run(3);
  EXPECT_EQ(nameOf(run.last), Name(0, kCamera, 1));
  for (size_t i = 0; i < 3; ++i) {
    const auto task = run.state.take(upTo(9));
    ASSERT_TRUE(task);
    EXPECT_EQ(nameOf(*task), Name(1, kLight, i));
    run.state.end(*task);
  }
  EXPECT_FALSE(run.state.take(upTo(9))) << "the fourth has no store yet";
  run.state.end(run.last);
  EXPECT_EQ(nameOf(*run.state.take(upTo(9))), Name(1, kLight, 3));
  EXPECT_EQ(nameOf(*run.state.take(upTo(9))), Name(2, kLight, 0)) << "beside the last light task";
}

TEST(ScheduleState, anIterationThatMayNotBeginIsNotBegunEarly) {
  BesideTheLastCameraTask run(3);
  size_t asked = 0;
  const auto alone = [&](uint64_t, size_t underWay) {
    ++asked;
    return underWay == 0;
  };
  EXPECT_FALSE(run.state.take(alone));
  EXPECT_EQ(asked, 1u);
  run.state.end(run.last);
  EXPECT_EQ(nameOf(*run.state.take(alone)), Name(1, kLight, 0));
}

TEST(ScheduleState, aTaskMayWaitForTheSameOneOfAnotherIteration) {
  // Three camera tasks an iteration, two iterations at once, each task after the same one of the iteration before.
  const Schedule schedule{
      .tasks = {3},
      .waits = {{.phase = 0, .on = 0, .earlier = 1, .sameTask = true}, {.phase = 0, .on = 0, .earlier = 2}}};
  ScheduleState state(schedule, 0);
  std::vector<ScheduledTask> first;
  for (size_t i = 0; i < 3; ++i) first.push_back(*state.take(upTo(9)));
  EXPECT_FALSE(state.take(upTo(9)));
  state.end(first[1]);
  EXPECT_FALSE(state.take(upTo(9))) << "tasks are handed out in order";
  state.end(first[0]);
  EXPECT_EQ(nameOf(*state.take(upTo(9))), Name(1, 0, 0));
  EXPECT_EQ(nameOf(*state.take(upTo(9))), Name(1, 0, 1));
  EXPECT_FALSE(state.take(upTo(9)));
  state.end(first[2]);
  EXPECT_EQ(nameOf(*state.take(upTo(9))), Name(1, 0, 2));
}

TEST(RunSchedule, runsEveryTaskOnceAndWaits) {
  constexpr size_t kLightTasks = 7, kCameraTasks = 5, kIterations = 40;
  for (const int threads : {1, 2, 8}) {
    for (const size_t ahead : {0u, 3u, 7u}) {
      std::mutex mutex;
      std::map<Name, int> runs;
      std::map<std::pair<uint64_t, size_t>, size_t> over;
      std::atomic<int> wrong = 0;
      const Schedule schedule = photonSchedule(kLightTasks, kCameraTasks, ahead);
      const auto allOver = [&](uint64_t iteration, size_t phase) {
        return over[{iteration, phase}] == schedule.tasks[phase];
      };
      oneapi::tbb::task_arena arena(threads);
      uint64_t end = 0;
      arena.execute([&] {
        end = runSchedule(schedule, 3, static_cast<size_t>(threads), upTo(3 + kIterations),
                          [&](const ScheduledTask& task) {
                            {
                              const std::lock_guard lock(mutex);
                              ++runs[nameOf(task)];
                              if (task.phase > 0 && !allOver(task.iteration, task.phase - 1)) ++wrong;
                              const bool cameraOver = task.iteration == 3 || allOver(task.iteration - 1, kCamera);
                              if (!cameraOver && !(task.phase == kLight && task.index < ahead)) ++wrong;
                            }
                            std::atomic<int> work = 0;
                            while (work < 1000) ++work;
                            const std::lock_guard lock(mutex);
                            ++over[{task.iteration, task.phase}];
                          });
      });
      EXPECT_EQ(end, 3 + kIterations);
      EXPECT_EQ(wrong, 0) << threads << " threads, " << ahead << " ahead";
      EXPECT_EQ(runs.size(), kIterations * schedule.taskCount());
      EXPECT_TRUE(std::ranges::all_of(runs, [](const auto& run) { return run.second == 1; }));
    }
  }
}

TEST(RunSchedule, finishesWhatHasBegun) {
  for (const uint64_t last : {0u, 1u, 4u}) {
    std::atomic<size_t> count = 0;
    const Schedule schedule = photonSchedule(4, 3, 2);
    oneapi::tbb::task_arena arena(2);
    arena.execute([&] { runSchedule(schedule, 0, 2, upTo(last), [&](const ScheduledTask&) { ++count; }); });
    EXPECT_EQ(count, last * schedule.taskCount());
  }
}

TEST(RunSchedule, throwsWhatATaskThrows) {
  oneapi::tbb::task_arena arena(2);
  const auto fails = [](const ScheduledTask& task) {
    if (task.iteration == 2 && task.phase == kMap) throw std::runtime_error("no memory");
  };
  EXPECT_THROW(arena.execute([&] { runSchedule(photonSchedule(4, 3, 2), 0, 2, upTo(100), fails); }),
               std::runtime_error);
}

}  // namespace
}  // namespace wavecrest
