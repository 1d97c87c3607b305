// Slices are whole iterations, so what a path needs is the same in each measurement.
#include "bench/throughput/turns.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/throughput/speed.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

RenderSettings measured(Method method) {
  RenderSettings settings = settingsOf(method);
  settings.measureStages = true;
  return settings;
}

Speed speedOf(const Scene& scene, size_t visits, double visitSeconds) {
  SpeedMeasurement measurement(scene, measured(Method::vcm));
  for (size_t visit = 0; visit < visits; ++visit) measurement.visit(visitSeconds);
  return measurement.speed();
}

TEST(Turns, aSessionThatHasRenderedGoesOnFromThere) {
  const Scene scene = smallBox(16, 16);
  const auto session = Session::create(scene, {});
  session->renderUntil(5, std::nullopt);
  SliceRenderer renderer(*session, 2);
  EXPECT_EQ(renderer.render().paths, 2u * 16 * 16);
  EXPECT_EQ(session->statistics().iterations, 7u);
}

TEST(Turns, slicesAreWholeIterationsAndOfEqualSize) {
  const Scene scene = smallBox(24, 16);
  for (const Method method : {Method::pt, Method::vcm, Method::lt}) {
    std::vector<std::unique_ptr<Session>> sessions;
    sessions.push_back(Session::create(scene, measured(method)));
    const auto slices = renderInTurn(sessions, {.seconds = 0.05, .fewestRounds = 3, .mostRounds = 5});
    ASSERT_GE(slices[0].size(), 3u);
    for (const Slice& slice : slices[0]) {
      EXPECT_EQ(slice.paths, slices[0][0].paths);
      EXPECT_EQ(slice.paths % (24 * 16), 0u);
    }
  }
}

TEST(Turns, itemsOfAPathAreTheSameInEveryMeasurement) {
  const Scene scene = smallBox(24, 16);
  const Speed a = speedOf(scene, 1, 0.2);
  const Speed b = speedOf(scene, 3, 0.15);
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (size_t i = 0; i < a.stages.size(); ++i) {
    // Other numbers of iterations: some 10^5 paths at the least, so a standard error of 0.3 % or less.
    EXPECT_NEAR(a.stages[i].itemsPerPath, b.stages[i].itemsPerPath, 0.015 * b.stages[i].itemsPerPath)
        << a.stages[i].name;
  }
}

TEST(Turns, visitsRenderTheSameIterations) {
  const Scene scene = smallBox(24, 16);
  SpeedMeasurement measurement(scene, measured(Method::pt));
  for (int visit = 0; visit < 2; ++visit) measurement.visit(0.05);
  const Speed speed = measurement.speed();
  const VisitSlices& slices = speed.scaling.front().slices;
  ASSERT_EQ(slices.size(), 2u);
  for (size_t k = 0; k < std::min(slices[0].size(), slices[1].size()); ++k) {
    EXPECT_EQ(slices[0][k].rays(), slices[1][k].rays()) << k;
  }
}

// The radius shrinks, so that slices of other iterations are other work.
TEST(Turns, slicesOfAMergingMethodAreTheSameWorkOnAnyNumberOfThreads) {
  const Scene scene = smallBox(24, 16);
  RenderSettings settings = measured(Method::vcm);
  settings.threads = 2;
  SpeedMeasurement measurement(scene, settings);
  measurement.visit(0.3);
  const Speed speed = measurement.speed();
  ASSERT_EQ(speed.scaling.size(), 2u);
  EXPECT_EQ(speed.scaling[0].slices[0][0].paths, speed.scaling[1].slices[0][0].paths);
}

}  // namespace
}  // namespace wavecrest
