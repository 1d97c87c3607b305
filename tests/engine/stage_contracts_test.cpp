// Contracts of stages: a wave as stages leave it keeps them, and each damage to it is found.
#include "engine/walks/stage_contracts.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/plan/render_plan.h"
#include "engine/walks/run_walk.h"
#include "kernels/columns/light_vertices.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr size_t kPaths = 64;

// A wave of camera paths after arrive, and light vertices stored before it.
class StageContractsTest : public testing::Test {
 protected:
  StageContractsTest() {
    context_.scene = &plan_.view;
    context_.pixels = area_.pixels.data();
    context_.mis = plan_.pipeline.cameraPass().strategies;
    context_.mis.lightPaths = kPaths;
    context_.counters = &counters_;
    context_.light.store = &store_;
    context_.limits = {.maxDepth = 6, .rouletteDepth = 6};
    wave_.pathCount = kPaths;
    walk(Walk::light, stages_.generateLightPaths);
    store_.beginDepth(wave_.rays.size);
    stages_.storeLightVertices(context_, wave_);
    // The same vertices again, one edge farther: paths of two vertices.
    context_.depth = 2;
    store_.beginDepth(wave_.rays.size);
    stages_.storeLightVertices(context_, wave_);
    walk(Walk::camera, stages_.generateCameraPaths);
  }

  void expectBroken(std::string_view stage, std::string_view what) {
    EXPECT_EQ(brokenContract(stage, context_, wave_), what) << stage;
  }

  const Scene scene_ =
      roomScene({.light = RoomLight::quad, .materials = RoomMaterials::mixed, .width = 8, .height = 8});
  const RenderSettings settings_ = [] {
    RenderSettings settings;
    settings.method = Method::bpt;
    settings.isa = bestIsa();
    settings.specialization = Specialization::complete;
    return settings;
  }();
  const RenderPlan<float> plan_ = planRender<float>(scene_, settings_);
  const Stages<float>& stages_ = findStages<float>(plan_.isa, settings_.precision, plan_.specialization);
  const FilmArea area_ = filmArea(scene_.film);
  Wave<float> wave_{kPaths, plan_.needs};
  LightStore<float> store_{kPaths, plan_.needs, plan_.lightUse};
  StageCounters counters_;
  StageContext<float> context_;

 private:
  void walk(Walk walk, Stage<float> generate) {
    context_.walk = walk;
    context_.depth = 0;
    generate(context_, wave_);
    context_.depth = 1;
    chooseIntersector(stages_, *plan_.scene).extend(context_, wave_);
    stages_.arrive(context_, wave_);
  }
};

TEST_F(StageContractsTest, areKeptByTheStages) {
  ASSERT_GT(wave_.rays.size, 8u);
  ASSERT_GT(wave_.joinable, 8u);
  ASSERT_LT(wave_.joinable, wave_.rays.size);
  ASSERT_GT(store_.vertices.size, 8u);
  for (const char* stage : {"arrive", "store", "scatter"}) expectBroken(stage, "");
  stages_.nextEvent(context_, wave_);
  ASSERT_GT(wave_.shadowRays.size, 0u);
  expectBroken("next event", "");
  chooseIntersector(stages_, *plan_.scene).extend(context_, wave_);
  expectBroken("extend", "");
}

TEST_F(StageContractsTest, ofQueues) {
  wave_.rays.size = kPaths + 1;
  expectBroken("scatter", "rays and paths within their memory");
  wave_.rays.size = wave_.paths.size - 1;
  expectBroken("scatter", "a state for each ray");
  wave_.rays.size = wave_.paths.size;
  wave_.shadowRays.size = kPaths + 1;
  expectBroken("scatter", "shadow rays within their memory");
  wave_.shadowRays.size = 0;
  context_.counters = nullptr;
  expectBroken("scatter", "a scene and counters");
}

TEST_F(StageContractsTest, ofPaths) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto damage = [&](float* column, float value, std::string_view what) {
    const float before = column[3];
    column[3] = value;
    expectBroken("scatter", what);
    column[3] = before;
  };
  damage(wave_.rays.directionX, 3, "unit directions");
  damage(wave_.rays.originY, kNaN, "finite origins");
  damage(wave_.paths.throughputB, kNaN, "throughputs without NaN");
  damage(wave_.paths.dVCM, -1, "MIS sums from 0");
  damage(wave_.paths.dVC, kNaN, "MIS sums from 0");
  damage(wave_.paths.rouletteScale, 0, "a scale for roulette");
  wave_.paths.lane[3] = 1u << 30;
  expectBroken("scatter", "lanes of the wave");
}

TEST_F(StageContractsTest, ofHitsAndVertices) {
  const uint32_t before = wave_.hits.primitive[2];
  wave_.hits.primitive[2] = context_.scene->primitiveCount;
  expectBroken("extend", "primitives of the scene");
  expectBroken("arrive", "vertices on primitives");
  wave_.hits.primitive[2] = before;
  wave_.surfaces.normalZ[2] += 1;
  expectBroken("arrive", "unit normals");
  wave_.surfaces.normalZ[2] -= 1;
  wave_.joinable = wave_.rays.size + 1;
  expectBroken("arrive", "diffuse vertices among joinable ones among all");
  wave_.joinable = wave_.rays.size;
  wave_.diffuse = wave_.rays.size;
  expectBroken("arrive", "diffuse vertices first");
  wave_.diffuse = wave_.joinable = 0;
  expectBroken("arrive", "joinable vertices before others");
}

TEST_F(StageContractsTest, ofShadowRays) {
  stages_.nextEvent(context_, wave_);
  wave_.shadowRays.red[1] = std::numeric_limits<float>::quiet_NaN();
  expectBroken("next event", "contributions without NaN");
  wave_.shadowRays.red[1] = 0;
  wave_.shadowRays.target[1] = 1u << 30;
  expectBroken("next event", "targets of shadow rays on the film or in the wave");
}

TEST_F(StageContractsTest, ofLightVertices) {
  auto& vertices = store_.vertices;
  const uint32_t next = vertices.next[0];
  ASSERT_NE(next, kNoIndex);
  vertices.next[0] = static_cast<uint32_t>(vertices.size);
  expectBroken("store", "links onwards");
  vertices.next[0] = 0;
  expectBroken("store", "links onwards");
  vertices.next[0] = next;
  vertices.lane[0] = kPaths;
  expectBroken("store", "light vertices of the wave's paths");
}

// contracts_test rests on this.
TEST_F(StageContractsTest, endTheProgramWhereAWalkChecksThem) {
  const StageCall<float> damage{.name = "scatter",
                                .run = [](const StageContext<float>&, Wave<float>& wave) { wave.paths.dVCM[3] = -1; },
                                .items = [](const Wave<float>& wave) { return wave.rays.size; },
                                .lanes = 1};
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        checksContracts = true;
        runStage(damage, context_, wave_, nullptr);
      },
      "scatter.*MIS sums from 0");
  runStage(damage, context_, wave_, nullptr);  // unchecked
}

}  // namespace
}  // namespace wavecrest
