// A method that is not in the list, from its page alone: what CONTRIBUTING says of adding one is all there is to do.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/learn/blocks.h"
#include "engine/learn/guide.h"
#include "engine/methods/method_list.h"
#include "engine/plan/render_plan.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// Path tracing as in Kajiya's paper: light is found by chance alone.
MethodPage naivePathTracing() {
  using enum StageId;
  return {{walk(Walk::camera, generateCameraPaths, {extend, arrive, scatter})}};
}

// The same, learning directions block by block.
MethodPage learningPathTracing() {
  using enum StageId;
  return {{walk(Walk::camera, generateCameraPaths, {extend, arrive, findCells, scatter}), learn(Fold::guide)}};
}

// The mean of an image by a method's page, one wave over all of its pixels at a time. What the page learns, it learns
// for the six sides that surfaces face, wherever they are.
double meanOf(const MethodPage& page, const Scene& scene, uint64_t seed, uint32_t iterations) {
  const FlushToZero flushToZero;
  RenderSettings settings;
  settings.isa = bestIsa();
  RenderPlan<float> plan = planRender<float>(scene, settings);
  plan.pipeline = makePipeline(page, *plan.stages, chooseIntersector(*plan.stages, *plan.scene));
  const SceneView<float>& view = plan.view;
  Guide guide(view.center, view.halfExtent, GuideTarget::radiance, 0, 1);
  plan.needs.cells = plan.needs.directions = page.has(Fold::guide);
  Film film(filmArea(scene.film));
  const size_t pixels = film.area().pixels.size();
  Wave<float> wave(pixels, plan.needs);
  StageCounters counters;
  StageContext<float> context;
  context.scene = &view;
  if (page.has(Fold::guide)) {
    context.learned.cells = &guide.cellTree();
    context.learned.guide = &guide.view();
    context.learned.records = true;
  }
  context.pixels = film.area().pixels.data();
  context.limits = settings.limits;
  context.mis = plan.pipeline.cameraPass().strategies;
  context.counters = &counters;
  for (uint32_t i = 0; i < iterations; ++i) {
    context.sampler = {SamplerKind::independent, seed, i};
    wave.firstPath = 0;
    wave.pathCount = pixels;
    runPass<float>(plan.pipeline.cameraPass(), context, wave, nullptr);
    film.add(wave);
    guide.gather(wave.directions, wave.radiance);
    wave.directions.size = 0;
    if (endOfBlock(i) == i + 1) guide.fold();
  }
  if (page.has(Fold::guide)) {
    EXPECT_GT(guide.statistics().guidedShare, 0.1) << "it has learned";
  }
  double sum = 0;
  for (const float value : film.resolve()) sum += static_cast<double>(value);
  return sum / static_cast<double>(3 * pixels);
}

TEST(ToyMethod, strategiesFollowFromItsPage) {
  const MethodPage page = naivePathTracing();
  EXPECT_EQ(strategiesOf(page), (PathStrategies{.emission = true}));
  const MisSettings weights = weightsOf(page, Walk::camera);
  EXPECT_TRUE(weights.emission);
  EXPECT_FALSE(weights.nextEvent || weights.connect || weights.camera || weights.merge || weights.powerHeuristic);
  EXPECT_FALSE(isBidirectional(page));
  EXPECT_FALSE(page.has(Fold::photonMap) || page.hasChains());
  EXPECT_EQ(strategiesOf(learningPathTracing()), strategiesOf(page)) << "a guide makes no other paths";
}

// The same image as path tracing with next event estimation: means over seeds, |t| <= 5. Returns the standard error.
double expectImageOfPathTracing(const MethodPage& page) {
  const Scene scene = sceneFile("validation/quad-over-plane", 16, 16);
  constexpr size_t kRuns = 12;
  double sum = 0, squares = 0;
  for (size_t run = 0; run < kRuns; ++run) {
    const double naive = meanOf(page, scene, run, 64), nextEvent = meanOf(pathTracing(), scene, 100 + run, 64);
    EXPECT_GT(nextEvent, 0);
    sum += naive - nextEvent;
    squares += (naive - nextEvent) * (naive - nextEvent);
  }
  const double mean = sum / kRuns;
  const double error = std::sqrt((squares / kRuns - mean * mean) / (kRuns - 1));
  EXPECT_GT(error, 0);
  EXPECT_LT(std::abs(mean), 5 * error);
  return error;
}

TEST(ToyMethod, rendersTheImageOfPathTracing) { expectImageOfPathTracing(naivePathTracing()); }

// And so does one that learns, with less noise: a lamp is worth learning where it is met by chance alone.
TEST(ToyMethod, learns) {
  EXPECT_LT(expectImageOfPathTracing(learningPathTracing()), 0.7 * expectImageOfPathTracing(naivePathTracing()));
}

}  // namespace
}  // namespace wavecrest
