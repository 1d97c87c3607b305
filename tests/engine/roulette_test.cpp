// Russian roulette and the depth limit: where they may end paths, and that they change no mean.
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kRoomWidth = 32, kRoomHeight = 24;

RenderSettings defaults() { return settingsFor({Precision::floating, SamplerKind::independent, Accel::small}); }

TEST(Roulette, changesNoMeanWhereverItBegins) {
  const Scene scene = sceneFile("cornell-diffuse", kRoomWidth, kRoomHeight);
  RenderSettings settings = defaults();
  settings.limits.rouletteDepth = 20;
  const SeedMeans latest = renderSeeds(scene, settings, samples(48, 12));
  for (const uint32_t depth : {1u, 5u}) {
    settings.limits.rouletteDepth = depth;
    const SeedMeans earlier = renderSeeds(scene, settings, samples(48, 12), 2000);  // independent of the others
    expectSameTruth(latest, earlier, "roulette from vertex " + std::to_string(depth));
  }
}

// Each walk of each method has the rule of its own.
TEST(Roulette, changesNoMeanWhateverItFollows) {
  const Scene scene = sceneFile("cornell-glossy", kRoomWidth, kRoomHeight);
  for (const Method method : {Method::pt, Method::lt, Method::bpt, Method::ppm, Method::bpm, Method::vcm}) {
    RenderSettings settings = defaults();
    settings.method = method;
    settings.limits.rouletteDepth = 2;
    settings.roulette = Roulette::throughput;
    const SeedMeans byThroughput = renderSeeds(scene, settings, samples(16, 4));
    uint64_t seed = 2000;
    for (const Roulette roulette : {Roulette::albedo, Roulette::efficiency}) {
      settings.roulette = roulette;
      expectSameTruth(byThroughput, renderSeeds(scene, settings, samples(16, 4), seed += 1000),
                      std::string(toString(method)) + ", " + std::to_string(static_cast<int>(roulette)));
    }
  }
}

// Throughputs divided by 0.05 and survivors that are never divided are where a wrong probability would show most: black
// walls in the one scene, in the other walls that take nothing away.
TEST(Roulette, changesNoMeanOfSmallAndLargeProbabilities) {
  for (const char* albedo : {"0.02", "1"}) {
    const Scene scene = sceneFile("validation/furnace-sphere", 16, 16, {{"albedo", albedo}});
    for (const Method method : {Method::pt, Method::lt, Method::bpt}) {
      RenderSettings settings = defaults();
      settings.method = method;
      settings.limits.rouletteDepth = 1;
      const SeedMeans byThroughput = renderSeeds(scene, settings, samples(32, 8));
      for (const Roulette roulette : {Roulette::albedo, Roulette::efficiency}) {
        settings.roulette = roulette;
        expectSameTruth(byThroughput, renderSeeds(scene, settings, samples(32, 8), 3000),
                        std::string(toString(method)) + ", albedo " + albedo);
      }
    }
  }
}

uint64_t raysOf(const Scene& scene, Method method, Roulette roulette) {
  RenderSettings settings = defaults();
  settings.method = method;
  settings.roulette = roulette;
  const auto session = Session::create(scene, settings);
  session->renderUntil(8, std::nullopt);
  return session->statistics().counters.raysClosest;
}

// At the fifth vertex a path has lost much. By throughput few go on, by albedo as many as at any vertex.
TEST(Roulette, endsFewerPathsByAlbedoOrEfficiencyThanByThroughput) {
  const Scene scene = sceneFile("cornell-diffuse", kRoomWidth, kRoomHeight);
  for (const Method method : {Method::pt, Method::lt, Method::bpt}) {
    const uint64_t rays = raysOf(scene, method, Roulette::throughput);
    EXPECT_GT(raysOf(scene, method, Roulette::albedo), rays * 102 / 100) << toString(method);
    const uint64_t efficient = raysOf(scene, method, Roulette::efficiency);
    if (method == Method::bpt) {
      EXPECT_EQ(efficient, rays) << "throughput alone is the most efficient there";
    } else {
      EXPECT_GT(efficient, rays * 101 / 100) << toString(method);
    }
  }
}

TEST(Roulette, hasTheSameImageWhateverTheThreadsAndWaves) {
  const Scene scene = sceneFile("cornell-glossy", kRoomWidth, kRoomHeight);
  for (const Method method : {Method::pt, Method::lt}) {
    for (const Roulette roulette : {Roulette::albedo, Roulette::efficiency}) {
      RenderSettings settings = defaults();
      settings.method = method;
      settings.roulette = roulette;
      const RgbImage image = render(scene, settings, 8);
      settings.threads = 7;
      settings.waveSize = 100;
      EXPECT_EQ(render(scene, settings, 8), image) << toString(method);
    }
  }
}

TEST(Roulette, shortensPaths) {
  const Scene scene = sceneFile("validation/closed-box", kRoomWidth, kRoomHeight);
  RenderSettings settings = defaults();
  uint64_t previous = UINT64_MAX;
  for (const uint32_t depth : {kUnlimitedDepth, 20u, 5u, 1u}) {
    settings.limits.rouletteDepth = depth;
    const auto session = Session::create(scene, settings);
    session->renderUntil(1, std::nullopt);
    const uint64_t rays = session->statistics().counters.raysClosest;
    EXPECT_LT(rays, previous) << "roulette from vertex " << depth;
    previous = rays;
  }
}

// METHODS 1.1: K counts edges. K = 1 shows emitters alone and asks for no shadow; K = 2 adds direct light.
TEST(MaxDepth, oneShowsOnlyEmitters) {
  const Scene scene = sceneFile("cornell-diffuse", kRoomWidth, kRoomHeight);
  RenderSettings settings = defaults();
  settings.limits.maxDepth = 1;
  const auto session = Session::create(scene, settings);
  session->renderUntil(4, std::nullopt);
  const RgbImage image = session->film().resolve();
  size_t lit = 0;
  for (size_t i = 0; i < image.size(); i += 3) {
    if (image[i] == 0.0f) continue;
    ++lit;
    // The lamp's radiance is 51, 36, 12; its border covers pixels in quarters.
    EXPECT_NEAR(image[i + 1] / image[i], 36.0 / 51, 1e-5);
    EXPECT_NEAR(std::remainder(image[i], 51.0 / 4), 0, 1e-4);
  }
  EXPECT_GT(lit, 3u);
  EXPECT_LT(lit, kRoomWidth * kRoomHeight / 10);
  EXPECT_EQ(session->statistics().counters.raysShadow, 0u);
  EXPECT_EQ(session->statistics().counters.raysClosest, 4u * kRoomWidth * kRoomHeight);
}

// What is stated holds, as far as light vertices and chains have room for it.
TEST(MaxDepth, isTheStatedOneWithinTheRoomOfTheMethod) {
  const auto depthOf = [](Method method, int stated) {
    RenderSettings settings;
    settings.method = method;
    settings.limits = pathLimits(stated, 5);
    return withinDepthOfMethod(settings).limits.maxDepth;
  };
  for (const Method method : {Method::pt, Method::gpt}) {
    EXPECT_EQ(depthOf(method, 4095), 4095u) << toString(method);
    EXPECT_EQ(depthOf(method, 5000), 5000u) << toString(method);
    EXPECT_EQ(depthOf(method, -1), 1u << 24) << toString(method);
  }
  for (const Method method : {Method::lt, Method::bpt, Method::vcm, Method::evcm}) {
    EXPECT_EQ(depthOf(method, 12), 12u) << toString(method);
    EXPECT_EQ(depthOf(method, 5000), 4095u) << toString(method);
    EXPECT_EQ(depthOf(method, -1), 4095u) << toString(method);
  }
  EXPECT_EQ(depthOf(Method::mlt, 12), 12u);
  EXPECT_EQ(depthOf(Method::mlt, 100), 64u);
  EXPECT_EQ(depthOf(Method::mlt, -1), 64u);
}

// A light vertex is joined by one edge at least: of K edges the light walk has K - 1. What the limit ends is counted.
TEST(MaxDepth, lightWalksHaveAnEdgeLess) {
  const Scene scene = sceneFile("validation/closed-box", kRoomWidth, kRoomHeight);
  for (const Method method : {Method::lt, Method::bpt, Method::vcm}) {
    RenderSettings settings = defaults();
    settings.method = method;
    settings.limits.maxDepth = 1;
    const auto session = Session::create(scene, settings);
    session->renderUntil(2, std::nullopt);
    const RenderStatistics statistics = session->statistics();
    EXPECT_EQ(statistics.counters.raysClosest, statistics.paths) << toString(method);
    EXPECT_EQ(statistics.counters.cutPaths, statistics.paths + statistics.lightPaths) << toString(method);
  }
}

TEST(MaxDepth, eachEdgeMoreAddsLight) {
  const Scene scene = sceneFile("cornell-diffuse", kRoomWidth, kRoomHeight);
  RenderSettings settings = defaults();
  settings.limits.rouletteDepth = kUnlimitedDepth;  // so that all runs trace the same paths
  RgbImage previous(3 * kRoomWidth * kRoomHeight, 0.0f);
  for (uint32_t maxDepth = 1; maxDepth <= 6; ++maxDepth) {
    settings.limits.maxDepth = maxDepth;
    const RgbImage image = render(scene, settings, 4);
    size_t brighter = 0;
    for (size_t i = 0; i < image.size(); ++i) {
      ASSERT_GE(image[i], previous[i] * (1 - 1e-6f)) << "K = " << maxDepth << ", value " << i;
      brighter += image[i] > previous[i] ? 1 : 0;
    }
    EXPECT_GT(brighter, maxDepth == 1 ? 0 : image.size() / 4) << "K = " << maxDepth;
    previous = image;
  }
}

}  // namespace
}  // namespace wavecrest
