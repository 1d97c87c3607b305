// Roulette of connections (METHODS 5.9): which are joined, what they then carry, and that no mean changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "engine/pilot/pilot_paths.h"
#include "engine/pilot/typical_brightness.h"
#include "tests/effort.h"
#include "tests/engine/bidirectional_walk.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kFilmWidth = 32, kFilmHeight = 24;
constexpr MisSettings kWithoutMerging{.emission = true, .nextEvent = true, .connect = true, .camera = true};

// What each connection of some iterations carries, by its largest channel.
class Carried : public WalkVisitor<float> {
 public:
  std::vector<double> values;

  void connection(uint32_t, uint32_t, Wave<float>& wave) override {
    const auto& rays = wave.shadowRays;
    for (size_t i = 0; i < rays.size; ++i) values.push_back(std::max({rays.red[i], rays.green[i], rays.blue[i]}));
  }
};

std::vector<double> carried(const Scene& scene, float rouletteBelow) {
  BidirectionalWalk<float> walk(scene, {.rouletteBelow = rouletteBelow}, kWithoutMerging);
  Carried carried;
  for (uint32_t iteration = 0; iteration < 8; ++iteration) walk.run(iteration, carried);
  return carried.values;
}

TEST(ConnectionRoulette, joinsInProportionAndKeepsTheSum) {
  const Scene scene = sceneFile("cornell-glossy", kFilmWidth, kFilmHeight);
  const std::vector<double> all = carried(scene, 0);
  ASSERT_GT(all.size(), 1000u);
  const double limit = 0.05;
  size_t above = 0;
  double expected = 0, sum = 0, ofNumber = 0, ofSum = 0;  // of those joined, with their variances
  for (const double c : all) {
    const double chance = std::min(c / limit, 1.0);
    above += c >= limit ? 1 : 0;
    expected += chance;
    ofNumber += chance * (1 - chance);
    sum += c;
    ofSum += c * std::max(limit - c, 0.0);
  }
  const std::vector<double> some = carried(scene, static_cast<float>(limit));
  EXPECT_LT(some.size(), all.size() / 2) << "the limit says nothing about roulette here";
  EXPECT_NEAR(static_cast<double>(some.size()), expected, 5 * std::sqrt(ofNumber));
  double sumOfSome = 0;
  size_t aboveOfSome = 0;
  for (const double c : some) {
    sumOfSome += c;
    // Probabilities are rounded up to 2^-24: by 1 % of the smallest that are met here.
    EXPECT_GE(c, limit * 0.99) << "what is below the limit carries the limit if it is joined";
    aboveOfSome += c > limit * (1 + 1e-5) ? 1 : 0;
  }
  EXPECT_NEAR(sumOfSome, sum, 5 * std::sqrt(ofSum));
  EXPECT_NEAR(static_cast<double>(aboveOfSome), static_cast<double>(above), 2) << "all of those above are joined";
}

RenderSettings settingsWithRoulette(Method method) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::bvh});
  settings.method = method;
  return settings;
}

TEST(ConnectionRoulette, changesNoMean) {
  const Scene scene = sceneFile("cornell-diffuse", kFilmWidth, kFilmHeight);
  for (const Method method : {Method::bpt, Method::vcm}) {
    RenderSettings settings = settingsWithRoulette(method);
    settings.connectionRoulette = 0;
    const SeedMeans all = renderSeeds(scene, settings, samples(24, 6));
    settings.connectionRoulette = 1;
    expectSameTruth(all, renderSeeds(scene, settings, samples(24, 6), 2000), std::string(toString(method)));
  }
}

uint64_t shadowRays(const Scene& scene, const RenderSettings& settings) {
  const auto session = Session::create(scene, settings);
  session->renderUntil(2, std::nullopt);
  return session->statistics().counters.raysShadow;
}

TEST(ConnectionRoulette, savesShadowRaysOfLargeScenesOnly) {
  const Scene scene = sceneFile("cornell-diffuse", kFilmWidth, kFilmHeight);
  RenderSettings settings = settingsWithRoulette(Method::bpt), all = settings;
  all.connectionRoulette = 0;
  EXPECT_LT(shadowRays(scene, settings), 0.9 * static_cast<double>(shadowRays(scene, all)));
  settings.accel = all.accel = Accel::small;
  EXPECT_EQ(shadowRays(scene, settings), shadowRays(scene, all));
}

// Which are joined does not depend on threads and waves. All is diffuse there, so images have the same bits.
TEST(ConnectionRoulette, isTheSameWhateverTheThreads) {
  const Scene scene = sceneFile("cornell-diffuse", kFilmWidth, kFilmHeight);
  RenderSettings settings = settingsWithRoulette(Method::bpt);
  settings.threads = 1;
  settings.waveSize = 256;
  const RgbImage one = render(scene, settings, 3);
  settings.threads = 3;
  settings.waveSize = 96;
  EXPECT_EQ(one, render(scene, settings, 3));
}

TEST(PilotPaths, ofAPixelAreDifferentOnes) {
  const Scene scene = sceneFile("cornell-diffuse", 1, 1);
  const RenderSettings settings = settingsWithRoulette(Method::bpt);
  const RenderPlan<float> plan = planRender<float>(scene, settings);
  const std::vector<double> paths = tracePilotPaths(plan, settings, filmArea(scene.film), 32, PilotLight::weighted);
  ASSERT_EQ(paths.size(), kPilotPaths);
  EXPECT_GT((std::set<double>(paths.begin(), paths.end()).size()), kPilotPaths / 2);
}

double brightnessOf(const Scene& scene) {
  const RenderSettings settings = settingsWithRoulette(Method::bpt);
  const RenderPlan<float> plan = planRender<float>(scene, settings);
  return typicalBrightness(plan, settings, filmArea(scene.film));
}

// A sky, and before it a square lamp of side 1 that fills a fortieth of the film.
Scene lampBeforeSky(const Rgb& sky, const Rgb& lamp) {
  Scene scene = sceneFile("cornell-diffuse", 48, 36);
  scene.shapes.clear();
  scene.emitters.clear();
  addShape(scene, Rectangle{{-0.5, -0.5, -15}, {1, 0, 0}, {0, 1, 0}}, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, lamp);
  Emitter constant;
  constant.kind = ConstantEmitter{sky};
  scene.emitters.push_back(constant);
  setCamera(scene, {0, 0, -5}, 40, 48, 36);
  return scene;
}

TEST(TypicalBrightness, isTheLargestChannelWhereTheImageIsOfOneColour) {
  EXPECT_NEAR(brightnessOf(lampBeforeSky({0.25, 3, 1}, {0.25, 3, 1})), 3, 1e-5);
}

TEST(TypicalBrightness, doesNotKnowALampInView) {
  const double typical = brightnessOf(lampBeforeSky({1, 1, 1}, {1e4, 1e4, 1e4}));  // the image's mean is 250
  EXPECT_NEAR(typical, 1, 1e-5);
}

TEST(TypicalBrightness, scalesWithTheLight) {
  const Scene scene = sceneFile("cornell-diffuse", 64, 48);
  Scene brighter = scene;
  for (Emitter& emitter : brighter.emitters) {
    for (double& channel : std::get<AreaEmitter>(emitter.kind).radiance.value) channel *= 1e9;
  }
  EXPECT_NEAR(brightnessOf(brighter) / brightnessOf(scene), 1e9, 1e9 * 1e-5);
}

}  // namespace
}  // namespace wavecrest
