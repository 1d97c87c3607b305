// The memory plan is what a session then holds.

#include <gtest/gtest.h>

#include "engine/inspect/inspection.h"
#include "engine/pilot/finished_plan.h"
#include "engine/plan/memory_plan.h"
#include "engine/plan/render_plan.h"
#include "engine/session/session.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

RenderSettings plannedSettings(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  return settings;
}

RenderStatistics statisticsOf(const Scene& scene, const RenderSettings& settings, uint64_t iterations) {
  const auto session = Session::create(scene, settings);
  session->renderUntil(iterations, std::nullopt);
  return session->statistics();
}

// Other waves and iterations walk other light paths than the plan's pilot: their stores may be some larger.
void expectNear(size_t plannedBytes, size_t heldBytes) {
  const auto planned = static_cast<double>(plannedBytes), held = static_cast<double>(heldBytes);
  EXPECT_GT(planned, 0.75 * held);
  EXPECT_LT(planned, 1.33 * held);
}

class MemoryPlanTest : public testing::TestWithParam<Method> {};

TEST_P(MemoryPlanTest, isExactForOneWave) {
  for (const char* name : {"cornell-diffuse", "cornell-mirror", "features/checkerboard", "features/envmap"}) {
    const Scene scene = sceneFile(name, 40, 30);
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      RenderSettings settings = plannedSettings(GetParam());
      settings.precision = precision;
      const MemoryPlan plan = planMemory(scene, settings);
      const RenderStatistics held = statisticsOf(scene, settings, 1);
      EXPECT_EQ(plan.bytesPerPath, held.bytesPerPath) << name;
      EXPECT_EQ(plan.use.scene, held.memory.scene) << name;
      EXPECT_EQ(plan.use.waves, held.memory.waves) << name;
      EXPECT_EQ(plan.use.film, held.memory.film) << name;
      EXPECT_EQ(plan.use.splats, held.memory.splats) << name;
      EXPECT_EQ(plan.use.lightVertices, held.memory.lightVertices) << name;
      EXPECT_EQ(plan.use.photonMap, held.memory.photonMap) << name;
      EXPECT_EQ(plan.use.learned, held.memory.learned) << name;
      EXPECT_EQ(plan.use.image, held.memory.image) << name;
    }
  }
}

TEST_P(MemoryPlanTest, isNearForManyWavesAndIterations) {
  const Scene scene = sceneFile("cornell-mirror", 160, 120);
  RenderSettings settings = plannedSettings(GetParam());
  settings.waveSize = 1024;
  const MemoryUse plan = planMemory(scene, settings).use;
  const MemoryUse held = statisticsOf(scene, settings, 4).memory;
  EXPECT_EQ(plan.waves, held.waves);
  EXPECT_EQ(plan.film, held.film);
  EXPECT_EQ(plan.splats, held.splats);
  expectNear(plan.total(), held.total());
}

INSTANTIATE_TEST_SUITE_P(Methods, MemoryPlanTest, testing::ValuesIn([] {
                           std::vector<Method> methods;
                           methods.reserve(std::size(kMethods));
                           for (const MethodEntry& entry : kMethods) {
                             // The plan of evcm has room for any choice.
                             if (!isChosenByTrials(entry.method)) methods.push_back(entry.method);
                           }
                           return methods;
                         }()),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// Whatever sampler the settings have for another method.
TEST(MemoryPlan, ofAnInspectionHasTheSamplerOfEachMethod) {
  const Scene scene = sceneFile("cornell-mirror", 40, 30);
  RenderSettings settings = plannedSettings(Method::pt);
  settings.sampler = SamplerKind::sobol;
  const SceneInspection facts = inspectScene(scene, settings);
  for (const MethodInspection& row : facts.methods) {
    settings.method = row.method;
    settings.sampler = bestSampler(settings);
    EXPECT_EQ(row.memory.photons, planMemory(scene, settings).photons) << toString(row.method);
  }
}

TEST(MemoryPlan, coversTheBootstrap) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 30);
  RenderSettings settings = plannedSettings(Method::mlt);
  const size_t few = planMemory(scene, settings).use.chains;
  constexpr uint32_t kMore = 300'000;
  settings.metropolis.bootstrapSamples += kMore;
  const size_t many = planMemory(scene, settings).use.chains;
  EXPECT_EQ(many - few, kMore * sizeof(float));
  // Numbers of samples are rounded for each length of paths.
  EXPECT_NEAR(static_cast<double>(statisticsOf(scene, settings, 1).memory.chains), static_cast<double>(many), 1e4);
}

TEST(MemoryPlan, severalIterationsAreUnderWayWhereOneIsTooLittleForAllThreads) {
  constexpr size_t kSmall = 256 * 192, kLarge = 1024 * 768;
  RenderSettings settings = plannedSettings(Method::vcm);
  const auto atOnce = [&](size_t pixels, uint32_t threads) {
    settings.threads = threads;
    return iterationsAtOnce(withPieces(settings, FilmSettings{}, pixels), pixels);
  };
  EXPECT_EQ(atOnce(kSmall, 1), 1u);
  EXPECT_EQ(atOnce(kSmall, 2), 1u);
  EXPECT_GT(atOnce(kSmall, 64), 1u);
  EXPECT_EQ(atOnce(kLarge, 64), 1u);
  EXPECT_GT(atOnce(32 * 32, 2), 1u);
  settings.lightPaths = kLarge;
  EXPECT_EQ(atOnce(kSmall, 64), 1u) << "light paths alone give all threads work";
}

// The light walks of lt store no vertices.
TEST(MemoryPlan, hasRoomForLightVerticesWhereTheyAreStored) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 30);
  const auto bytes = [&](Method method) { return planMemory(scene, plannedSettings(method)).use.lightVertices; };
  EXPECT_LT(10 * bytes(Method::lt), bytes(Method::bpt));
}

// With one light path per pixel no photon would be found.
TEST(MemoryPlan, methodsThatOnlyMergeHaveLightPathsOnAFilmOfOnePixel) {
  const Scene scene = sceneFile("cornell-diffuse", 1, 1);
  const auto lightPaths = [&](const RenderSettings& settings) { return planMemory(scene, settings).lightPaths; };
  for (const Method method : {Method::ppm, Method::bpm}) {
    RenderSettings settings = plannedSettings(method);
    EXPECT_EQ(lightPaths(settings), kLeastLightPaths);
    const RenderStatistics statistics = statisticsOf(scene, settings, 3);
    EXPECT_EQ(statistics.paths, 3u);
    EXPECT_EQ(statistics.lightPaths, 3 * kLeastLightPaths);
    settings.lightPaths = 7;
    EXPECT_EQ(lightPaths(settings), 7u);
  }
  EXPECT_EQ(lightPaths(plannedSettings(Method::vcm)), 1u);
  EXPECT_EQ(lightPaths(plannedSettings(Method::bpt)), 1u);
}

// A map and stores for each iteration under way.
TEST(MemoryPlan, holdsAllIterationsUnderWay) {
  const Scene scene = sceneFile("cornell-mirror", 160, 120);
  RenderSettings settings = plannedSettings(Method::vcm);
  const MemoryUse one = planMemory(scene, settings).use;
  settings.threads = 16;
  const MemoryUse many = planMemory(scene, settings).use;
  EXPECT_GT(many.photonMap, 3 * one.photonMap / 2);
  EXPECT_GT(many.lightVertices, 3 * one.lightVertices / 2);
  const MemoryUse held = statisticsOf(scene, settings, 6).memory;
  expectNear(many.photonMap, held.photonMap);
  expectNear(many.lightVertices, held.lightVertices);
}

TEST(MemoryPlan, growsWithThreads) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 30);
  RenderSettings settings = plannedSettings(Method::lt);
  const MemoryUse one = planMemory(scene, settings).use;
  settings.threads = 3;
  const MemoryUse three = planMemory(scene, settings).use;
  EXPECT_LT(three.waves, one.waves) << "of a small film each thread's waves are smaller";
  EXPECT_EQ(three.film, one.film);
}

// A bounded number of films of splats, whatever the number of threads. Threads that share them sort a queue each.
TEST(MemoryPlan, hasAQueueOfSplatsForEachOfManyThreads) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 30);
  RenderSettings settings = plannedSettings(Method::lt);
  const size_t film = planMemory(scene, settings).use.splats;
  for (const uint32_t threads : {2u, 3u, 30u}) {
    settings.threads = threads;
    const size_t wave = withPieces(settings, scene.film, size_t{40} * 30).waveSize;
    const size_t queues = threads > kSplatFilms ? threads * Splats<float>().bytes(wave) : 0;
    EXPECT_EQ(planMemory(scene, settings).use.splats, kSplatFilms * film + queues) << threads;
  }
  // A session has the queues of those threads that had work.
  for (const Method method : {Method::lt, Method::mlt}) {
    RenderSettings own = plannedSettings(method);
    own.threads = 3;
    own.metropolis.chains = 256;
    own.metropolis.bootstrapSamples = 8192;
    EXPECT_GT(statisticsOf(scene, own, 1).memory.splats, kSplatFilms * film) << toString(method);
  }
}

// In vcm a thread copies the light vertices that its wave of camera paths is connected with into a store of its own,
// unless a light wave's store holds just these. It copies those of as many light paths as the wave has camera paths,
// even if the iteration has fewer light paths: some are then copied several times.
TEST(MemoryPlan, hasRoomForLightVerticesThatAreCollected) {
  const Scene scene = sceneFile("cornell-mirror", 160, 120);
  RenderSettings settings = plannedSettings(Method::vcm);
  settings.lightPaths = 100;
  const MemoryUse plan = planMemory(scene, settings).use;
  EXPECT_GT(plan.lightVertices, settings.waveSize * sizeof(VertexRow<float>));
  const MemoryUse held = statisticsOf(scene, settings, 3).memory;
  expectNear(plan.lightVertices, held.lightVertices);
  // Methods that do not connect collect nothing.
  settings.method = Method::ppm;
  EXPECT_LT(5 * planMemory(scene, settings).use.lightVertices, plan.lightVertices);
}

// The pilot walks fewer light paths than a long wave has.
TEST(MemoryPlan, hasRoomForTheLightVerticesOfLongWaves) {
  const Scene scene = sceneFile("cornell-mirror", 256, 192);
  for (const Method method : {Method::ppm, Method::bpt, Method::vcm}) {
    SCOPED_TRACE(std::string(toString(method)));
    RenderSettings settings = plannedSettings(method);
    settings.waveSize = 1u << 16;
    const MemoryUse plan = planMemory(scene, settings).use;
    expectNear(plan.lightVertices, statisticsOf(scene, settings, 2).memory.lightVertices);
  }
}

// ---- budget ---------------------------------------------------------------------------------------------------------

// A quarter of the light paths' memory: their number shrinks, the session holds no more than it may, and its film has
// seen that many light paths.
TEST(MemoryBudget, lowersTheNumberOfLightPathsAndIsKept) {
  const Scene scene = sceneFile("cornell-mirror", 160, 120);
  for (const Method method : {Method::ppm, Method::bpm, Method::vcm}) {
    RenderSettings settings = plannedSettings(method);
    settings.waveSize = 512;
    const MemoryPlan whole = planMemory(scene, settings);
    EXPECT_EQ(whole.lightPaths, 160u * 120);
    const size_t lightBytes = whole.use.lightVertices + whole.use.photonMap;
    settings.memoryBytes = whole.use.total() - lightBytes * 3 / 4;
    const MemoryPlan plan = planMemory(scene, settings);
    EXPECT_LE(plan.use.total(), *settings.memoryBytes);
    EXPECT_LT(plan.lightPaths, whole.lightPaths / 3);
    EXPECT_GT(plan.lightPaths, whole.lightPaths / 6);
    const RenderStatistics held = statisticsOf(scene, settings, 3);
    EXPECT_LE(held.memory.total(), *settings.memoryBytes * 101 / 100) << toString(method);
    EXPECT_EQ(held.lightPaths, 3 * plan.lightPaths);
    EXPECT_EQ(held.paths, 3u * 160 * 120);
  }
}

TEST(MemoryBudget, thatSufficesChangesNothing) {
  const Scene scene = sceneFile("cornell-diffuse", 80, 60);
  for (const MethodEntry& entry : kMethods) {
    RenderSettings settings = plannedSettings(entry.method);
    const MemoryPlan whole = planMemory(scene, settings);
    settings.memoryBytes = whole.use.total();
    EXPECT_EQ(planMemory(scene, settings).lightPaths, whole.lightPaths) << entry.name;
  }
}

TEST(MemoryBudget, thatIsTooSmallIsRefused) {
  const Scene scene = sceneFile("cornell-diffuse", 80, 60);
  for (const MethodEntry& entry : kMethods) {
    RenderSettings settings = plannedSettings(entry.method);
    settings.memoryBytes = 100'000;  // less than the film
    EXPECT_THROW(planMemory(scene, settings), MemoryBudgetError) << entry.name;
    EXPECT_THROW(Session::create(scene, settings), MemoryBudgetError) << entry.name;
  }
}

// Trials may choose path tracing. A guide that is asked for needs its memory.
TEST(MemoryBudget, ofTrialsSufficesWhereItDoesForPathTracing) {
  const Scene scene = sceneFile("cornell-diffuse", 80, 60);
  const size_t least = planMemory(scene, plannedSettings(Method::pt)).use.total();
  for (const Method method : {Method::gpt, Method::evcm}) {
    RenderSettings settings = plannedSettings(method);
    settings.guide = GuideTarget::automatic;
    const DryPlan whole = planWithoutSession(scene, settings);
    EXPECT_EQ(whole.method, method);
    EXPECT_GT(whole.memory.use.total(), least);
    settings.memoryBytes = least;
    const DryPlan plan = planWithoutSession(scene, settings);
    EXPECT_EQ(plan.method, Method::pt);
    EXPECT_EQ(plan.memory.use.total(), least);
    settings.memoryBytes = least - 1;
    EXPECT_THROW(planWithoutSession(scene, settings), MemoryBudgetError) << toString(method);
  }
  RenderSettings learns = plannedSettings(Method::gpt);
  learns.guide = GuideTarget::radiance;
  learns.memoryBytes = least;
  EXPECT_THROW(planWithoutSession(scene, learns), MemoryBudgetError);
}

TEST(MemoryBudget, ofMethodsWithoutAPhotonMapLeavesTheirLightPathsAlone) {
  const Scene scene = sceneFile("cornell-diffuse", 80, 60);
  RenderSettings settings = plannedSettings(Method::bpt);
  settings.lightPaths = 1000;
  EXPECT_THROW(planMemory(scene, settings), std::invalid_argument);
}

}  // namespace
}  // namespace wavecrest
