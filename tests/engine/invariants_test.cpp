// The integers of a path tracer: what goes into each stage and comes out, depth by depth (METHODS 9.9).
//
// a: rays into extend, h: hits, m: misses; nd: vertices with a finite lobe, which here are all.
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr size_t kPaths = 1000;

struct DepthCounts {
  size_t rays = 0, hits = 0, misses = 0, vertices = 0, shadowRays = 0, survivors = 0;
};

// Walks one wave of camera paths by hand, stage by stage.
class WaveWalk {
 public:
  WaveWalk(const Scene& scene, PathLimits limits)
      : compiled_(compileScene<float>(scene, Accel::small)),
        stages_(findStages<float>(bestIsa(), Precision::floating,
                                  chooseSpecialization(featuresOf(Specialization::smooth), Precision::floating))),
        area_(FilmArea::make(0, 0, scene.film.width, scene.film.height)) {
    context_.scene = &compiled_->view;
    context_.pixels = area_.pixels.data();
    context_.limits = limits;
    context_.counters = &counters;
    wave_.pathCount = kPaths;
    stages_.generateCameraPaths(context_, wave_);
    for (context_.depth = 1; context_.depth <= limits.maxDepth; ++context_.depth) depths.push_back(step());
  }

  StageCounters counters;
  std::vector<DepthCounts> depths;  // [0] is depth 1

 private:
  DepthCounts step() {
    DepthCounts count;
    const StageCounters before = counters;
    count.rays = wave_.rays.size;
    stages_.extendSmall(context_, wave_);
    for (size_t i = 0; i < wave_.hits.size; ++i) count.hits += wave_.hits.primitive[i] != kMiss ? 1 : 0;
    EXPECT_EQ(wave_.hits.size, count.rays);
    EXPECT_EQ(counters.raysClosest - before.raysClosest, count.rays);
    stages_.arrive(context_, wave_);
    count.misses = counters.misses - before.misses;
    count.vertices = wave_.rays.size;
    EXPECT_EQ(wave_.paths.size, count.vertices);
    EXPECT_EQ(wave_.surfaces.size, count.vertices);
    stages_.nextEvent(context_, wave_);
    count.shadowRays = wave_.shadowRays.size;
    stages_.occludeSmall(context_, wave_);
    EXPECT_EQ(wave_.shadowRays.size, 0u);
    EXPECT_EQ(counters.raysShadow - before.raysShadow, count.shadowRays);
    stages_.scatter(context_, wave_);
    count.survivors = wave_.rays.size;
    EXPECT_EQ(wave_.paths.size, count.survivors);
    return count;
  }

  std::unique_ptr<CompiledScene<float>> compiled_;
  const Stages<float>& stages_;
  const FilmArea area_;
  StageContext<float> context_;
  Wave<float> wave_{kPaths, {.shadingNormals = true, .textures = true, .rouletteScale = true, .connections = true}};
};

// 1: every ray hits or misses. 2: what scatter lets through is what extend gets next; the last depth lets nothing
// through. 4: at most one shadow ray for each vertex.
TEST(Invariants, raysAreConservedFromStageToStage) {
  const PathLimits limits{.maxDepth = 12, .rouletteDepth = 5};
  const WaveWalk walk(sceneFile("cornell-diffuse", 40, 27), limits);
  EXPECT_EQ(walk.depths[0].rays, kPaths);
  for (size_t i = 0; i < walk.depths.size(); ++i) {
    const DepthCounts& d = walk.depths[i];
    EXPECT_EQ(d.hits + d.misses, d.rays) << "depth " << i + 1;
    EXPECT_EQ(d.vertices, i + 1 < limits.maxDepth ? d.hits : 0) << "depth " << i + 1;
    EXPECT_LE(d.shadowRays, d.vertices) << "depth " << i + 1;
    EXPECT_LE(d.survivors, d.vertices) << "depth " << i + 1;
    if (i + 1 < walk.depths.size()) {
      EXPECT_EQ(walk.depths[i + 1].rays, d.survivors) << "depth " << i + 1;
    }
  }
  EXPECT_EQ(walk.depths.back().survivors, 0u);
}

// 2, 3: where nothing absorbs and nothing leaks, only roulette ends paths, and not before its depth.
TEST(Invariants, inAClosedRoomOnlyRouletteEndsPaths) {
  const PathLimits limits{.maxDepth = 20, .rouletteDepth = 5};
  const WaveWalk walk(sceneFile("validation/closed-box", 40, 27), limits);
  for (size_t depth = 1; depth < limits.maxDepth; ++depth) {
    const DepthCounts& d = walk.depths[depth - 1];
    EXPECT_EQ(d.misses, 0u);
    if (depth < limits.rouletteDepth) {
      EXPECT_EQ(d.survivors, d.vertices) << "depth " << depth;
    } else if (depth == limits.rouletteDepth) {
      EXPECT_LT(d.survivors, d.vertices) << "albedo 0.5 survives with 0.5^5";
    }
  }
}

// 11: with K = 2 light is found at the first two vertices, next event estimation happens at the first alone, and
// nothing scatters from the second.
TEST(Invariants, depthTwoStopsAfterTheFirstVertex) {
  const WaveWalk walk(sceneFile("validation/closed-box", 40, 27), {.maxDepth = 2, .rouletteDepth = 5});
  EXPECT_GT(walk.depths[0].shadowRays, kPaths / 2);
  EXPECT_EQ(walk.depths[0].survivors, kPaths);
  EXPECT_EQ(walk.depths[1].hits, kPaths);
  EXPECT_EQ(walk.depths[1].vertices, 0u);
  EXPECT_EQ(walk.depths[1].shadowRays, 0u);
  EXPECT_EQ(walk.depths[1].survivors, 0u);
}

// The session's statistics add up to the same.
TEST(Invariants, statisticsAddUp) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 27);
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.measureStages = true;
  settings.waveSize = 100;
  const auto session = Session::create(scene, settings);
  session->renderUntil(3, std::nullopt);
  const RenderStatistics s = session->statistics();
  const auto items = [&](const std::string& name) {
    for (const auto& row : s.stages) {
      if (row.name == name) return row.items;
    }
    ADD_FAILURE() << "no stage " << name;
    return uint64_t{0};
  };
  EXPECT_EQ(s.iterations, 3u);
  EXPECT_EQ(s.paths, 3u * 40 * 27);
  EXPECT_EQ(items("generate"), s.paths);
  EXPECT_EQ(items("extend"), s.counters.raysClosest);
  EXPECT_EQ(items("arrive"), s.counters.raysClosest);
  EXPECT_EQ(items("occlude"), s.counters.raysShadow);
  EXPECT_EQ(items("next event"), items("scatter"));
  EXPECT_LE(items("next event"), items("arrive") - s.counters.misses);
  EXPECT_GE(s.counters.raysClosest, s.paths);
  EXPECT_EQ(s.counters.nonFinite, 0u);  // 14
}

// 3: the leak counter over many bounces, where rays start on the walls themselves. Each case has 230,400 paths of 64
// edges with WAVECREST_THOROUGH, else a quarter of them.
struct LeakCase {
  const char* name;
  Accel accel;
  Precision precision;
};
class PathLeakTest : public testing::TestWithParam<LeakCase> {
 protected:
  void expectNoLeak(Scene scene) {
    for (Material& material : scene.materials) {
      material.kind = Diffuse{{{1, 1, 1}}};
      material.twoSided = true;  // the back of a lamp absorbs nothing
    }
    RenderSettings settings = settingsFor({GetParam().precision, SamplerKind::independent, GetParam().accel});
    settings.limits = {.maxDepth = 64, .rouletteDepth = 64};
    const auto session = Session::create(scene, settings);
    session->renderUntil(samples(100, 4), std::nullopt);
    const RenderStatistics s = session->statistics();
    EXPECT_EQ(s.counters.misses, 0u) << "of " << s.counters.raysClosest << " rays";
    EXPECT_EQ(s.counters.raysClosest, s.paths * 64) << "paths were lost on the way";
    EXPECT_EQ(s.counters.nonFinite, 0u);
  }
};

TEST_P(PathLeakTest, closedBox) { expectNoLeak(sceneFile("validation/closed-box", 48, 48)); }
TEST_P(PathLeakTest, closedSphere) { expectNoLeak(sceneFile("validation/closed-sphere", 48, 48)); }
TEST_P(PathLeakTest, closedCornellBox) { expectNoLeak(closedCornellBox(48, 48)); }

INSTANTIATE_TEST_SUITE_P(PathTracing, PathLeakTest,
                         testing::Values(LeakCase{"embree_float", Accel::embree, Precision::floating},
                                         LeakCase{"embree_double", Accel::embree, Precision::doubled},
                                         LeakCase{"bvh_float", Accel::bvh, Precision::floating},
                                         LeakCase{"bvh_double", Accel::bvh, Precision::doubled},
                                         LeakCase{"small_float", Accel::small, Precision::floating},
                                         LeakCase{"small_double", Accel::small, Precision::doubled}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace wavecrest
