// Limits of paths, of iterations and of inputs: kept to, or counted and said.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "bench/extremes/extreme_scenes.h"
#include "engine/compile/compiled_scene.h"
#include "engine/compile/pick_table.h"
#include "engine/compile/textures.h"
#include "engine/plan/render_plan.h"
#include "engine/scene/scene_error.h"
#include "engine/tasks/flush_to_zero.h"
#include "tests/engine/instanced_scenes.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

RenderSettings settingsWithin(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.limits = pathLimits(-1, 5);
  return settings;
}

std::unique_ptr<Session> rendered(const Scene& scene, const RenderSettings& settings, uint64_t iterations) {
  auto session = Session::create(scene, settings);
  session->renderUntil(iterations, std::nullopt);
  return session;
}

TEST(PathLimits, withoutOneNoPathIsCut) {
  const auto session = rendered(shiningRoom(0.999), settingsWithin(Method::pt), 8);
  EXPECT_EQ(session->statistics().counters.cutPaths, 0u);
}

// After K edges a path of constant albedo has carried a^(K-1) to its last surface, in the mean whatever roulette does.
TEST(PathLimits, whatTheyCutIsCounted) {
  constexpr double kAlbedo = 0.9;
  constexpr uint32_t kEdges = 12;
  RenderSettings settings = settingsWithin(Method::pt);
  settings.limits.maxDepth = kEdges;
  const RenderStatistics statistics = rendered(shiningRoom(kAlbedo), settings, 64)->statistics();
  EXPECT_GT(statistics.counters.cutPaths, 0u);
  const double carried = statistics.counters.cutThroughput / static_cast<double>(statistics.paths);
  // Of 9216 paths three in ten get that far, with throughputs about 1: a standard error of 1.5 %.
  EXPECT_NEAR(carried / std::pow(kAlbedo, kEdges - 1), 1, 0.06);
}

// Where no limit is stated, chains have memory for kChainDepth edges.
TEST(PathLimits, whatChainsCutIsCounted) {
  RenderSettings settings = settingsWithin(Method::mlt);
  settings.metropolis.variant = MetropolisVariant::pssmlt;
  settings.metropolis.chains = 256;
  settings.metropolis.bootstrapSamples = 1024;
  EXPECT_GT(rendered(shiningRoom(0.999), settings, 1)->statistics().counters.cutPaths, 0u);
}

// Its radius is that of an iteration, and so are its weights.
TEST(PhotonMapIterations, areFinishedWhereTimeRunsOut) {
  for (const Method method : {Method::vcm, Method::ppm}) {
    Scene scene = lampBox({});
    scene.film.width = scene.film.height = 96;
    RenderSettings settings = settingsWithin(method);
    settings.waveSize = 256;
    const auto session = Session::create(scene, settings);
    double seconds = 0;
    while (session->statistics().paths == 0) session->renderUntil(std::nullopt, seconds += 0.005);
    const RenderStatistics statistics = session->statistics();
    EXPECT_EQ(statistics.paths, statistics.iterations * 96 * 96) << toString(method);
    EXPECT_EQ(statistics.lightPaths, statistics.iterations * 96 * 96) << toString(method);
  }
}

// METHODS 6.1: the exponent, by its values.
TEST(MergeRadius, shrinksByItsExponent) {
  RenderSettings settings = settingsWithin(Method::vcm);
  settings.radius = 0.01;
  const auto radius = [&](double alpha, uint64_t iteration) {
    settings.radiusAlpha = alpha;
    const MergeRadius merges{.first = *settings.radius, .alpha = settings.radiusAlpha, .scene = 2};
    return misSettings({.merge = true}, merges, 100, iteration).radius / 2;
  };
  for (const double alpha : {0.0, 0.5, 0.75, 1.0}) {
    EXPECT_DOUBLE_EQ(radius(alpha, 0), 0.01) << alpha;
    EXPECT_NEAR(radius(alpha, 99), 0.01 * std::pow(10.0, alpha - 1), 1e-12) << alpha;
    EXPECT_NEAR(radius(alpha, 9999), 0.01 * std::pow(100.0, alpha - 1), 1e-12) << alpha;
  }
  settings.radius = 1e-9;
  EXPECT_EQ(radius(0.75, 0), kSmallestRadius);
}

// ---- sizes ----------------------------------------------------------------------------------------------------------

Scene sphereOfRadius(double radius) {
  Scene scene = shiningRoom(0.5);
  addShape(scene, Sphere{.center = {0, 0, 0}, .radius = radius}, 0);
  return scene;
}

bool isRefused(const Scene& scene) {
  try {
    Session::create(scene, settingsWithin(Method::pt));
    return false;
  } catch (const SceneError&) {
    return true;
  }
}

TEST(SceneRange, whatSinglePrecisionCannotMultiplyIsRefused) {
  for (const double radius : {1e30, 1e14, 1e-30}) EXPECT_TRUE(isRefused(sphereOfRadius(radius))) << radius;
  for (const double radius : {1e12, 1e-12}) EXPECT_FALSE(isRefused(sphereOfRadius(radius))) << radius;
}

TEST(PathNumbers, moreThanRandomNumbersTellApartAreRefused) {
  Scene scene = shiningRoom(0.5);
  scene.film.width = scene.film.height = 16385;  // 2^28 and some pixels, of which one is rendered
  scene.film.cropWidth = scene.film.cropHeight = 1;
  EXPECT_THROW(Session::create(scene, settingsWithin(Method::pt)), SceneError);
  scene.film.width = 16383;
  EXPECT_NO_THROW(Session::create(scene, settingsWithin(Method::pt)));
  RenderSettings many = settingsWithin(Method::ppm);
  many.lightPaths = (uint64_t{1} << 28) + 1;
  EXPECT_THROW(Session::create(shiningRoom(0.5), many), SceneError);
}

// Beyond kFarthestLight as well.
TEST(SceneRange, eyesAndLightsTooFarFromALargeSceneAreRefused) {
  Scene scene = sphereOfRadius(1e12);
  for (const auto& [distance, refused] : {std::pair{5e12, false}, std::pair{3e14, true}}) {
    setCamera(scene, {0, 0, distance}, 60, 8, 8);
    EXPECT_EQ(isRefused(scene), refused) << "eye at " << distance;
  }
  for (const auto& [distance, refused] : {std::pair{1e14, false}, std::pair{1e16, true}}) {
    scene = sphereOfRadius(1e11);
    addEmitter(scene, PointEmitter{.position = {distance, 0, 0}, .intensity = {1, 1, 1}});
    EXPECT_EQ(isRefused(scene), refused) << "light at " << distance;
  }
}

// Rays from within a room, with a ball of many faces in it, always meet something.
TEST(SceneRange, roomsAtItsEndsAreClosed) {
  constexpr size_t kRays = 2048;
  for (const double size : {6e-9, 1.1e12}) {
    Scene scene = lampBox({.size = size});
    addShape(scene, ballMesh({0, 0, 0}, 0.2 * size, 24), 0);
    const auto compiled = compileScene<float>(scene, Accel::bvh);
    const std::vector<RandomRay> rays = randomRays(kRays, 0.999, 7);
    Wave<float> wave(kRays, {});
    StageCounters counters;
    StageContext<float> context;
    context.scene = &compiled->view;
    context.counters = &counters;
    const FlushToZero flushToZero;
    for (const Isa isa : availableIsas()) {
      for (context.depth = 1; context.depth <= 2; ++context.depth) {  // packets, then single rays
        wave.setVertices(0, 0);
        wave.rays.claim(kRays);
        for (size_t i = 0; i < kRays; ++i) {
          wave.rays.originX[i] = static_cast<float>(rays[i].origin[0] * size);
          wave.rays.originY[i] = static_cast<float>(rays[i].origin[1] * size);
          wave.rays.originZ[i] = static_cast<float>(rays[i].origin[2] * size);
          wave.rays.directionX[i] = static_cast<float>(rays[i].direction[0]);
          wave.rays.directionY[i] = static_cast<float>(rays[i].direction[1]);
          wave.rays.directionZ[i] = static_cast<float>(rays[i].direction[2]);
        }
        findStages<float>(isa, Precision::floating, Specialization::complete).extendBvh(context, wave);
        size_t misses = 0;
        for (size_t i = 0; i < kRays; ++i) misses += wave.hits.primitive[i] == kMiss ? 1 : 0;
        EXPECT_EQ(misses, 0u) << size << ' ' << toString(isa) << ", depth " << context.depth;
      }
    }
  }
}

// The test of a face makes cubes of lengths.
TEST(SceneRange, aSceneOfTinyFacesIsRefused) {
  for (const auto& [side, refused] : {std::pair{1e-14, true}, std::pair{1e-9, true}, std::pair{2e-8, false}}) {
    Scene scene;
    addMaterial(scene, Diffuse{});
    addEmitter(scene, ConstantEmitter{{1, 1, 1}});
    addShape(scene, Rectangle{{0, 0, 0}, {side, 0, 0}, {0, side, 0}}, 0);
    EXPECT_EQ(isRefused(scene), refused) << side;
  }
}

// ---- environment maps of more texels than a number has bits ---------------------------------------------------------

// A wide map whose table is made by hand: all weight in a few texels, in the last rows and columns too.
TEST(LargeEnvironment, tableLeadsToEveryTexel) {
  EnvmapEmitter emitter;
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 5000;  // no power of two
  bitmap->height = 3500;
  bitmap->channels = 1;
  bitmap->pixels.assign(size_t{bitmap->width} * bitmap->height, 1.0f);
  emitter.bitmap = bitmap;
  const Environment environment = compileEnvironment(emitter);
  // What the alias table gives each row is its probability: an entry's own share, and what others hand on.
  std::vector<double> drawn(bitmap->height, 0), expected(bitmap->height, 0);
  uint32_t lastColumn = 0;
  const std::vector<double> rows = entryShares(bitmap->height), columns = entryShares(bitmap->width);
  for (size_t i = 0; i < environment.table.size(); ++i) {
    const AliasEntry& entry = environment.table[i];
    const double each = rows[i / bitmap->width] * columns[i % bitmap->width];
    drawn[i / bitmap->width] += each * static_cast<double>(entry.keep);
    lastColumn = std::max(lastColumn, entry.other & ((1u << kTexelBits) - 1));
    drawn.at(entry.other >> kTexelBits) += each * (1 - static_cast<double>(entry.keep));
    expected[i / bitmap->width] += static_cast<double>(environment.probability[i]);
  }
  EXPECT_LT(lastColumn, bitmap->width);
  for (uint32_t row = 0; row < bitmap->height; ++row) EXPECT_NEAR(drawn[row], expected[row], 1e-8) << row;
}

}  // namespace
}  // namespace wavecrest
