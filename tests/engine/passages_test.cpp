// Surfaces that let light straight on (METHODS 3.10): methods agree with each other, and with the same surfaces cut
// out.
//
// 16 seeds each. False alarms as in render_statistics.h; merging alone may differ by 2 % of the mean, its bias by the
// radius.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "engine/plan/render_plan.h"
#include "engine/scene/scene_error.h"
#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSheetsWidth = 24, kSheetsHeight = 16;

RenderSettings passageSettings(Method method, Accel accel = Accel::small) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, accel});
  settings.method = method;
  settings.waveSize = 256;
  settings.radius = 0.01;
  settings.metropolis.chains = 256;
  settings.metropolis.bootstrapSamples = 8192;
  return settings;
}

uint64_t passageIterations() { return samples(48, 2); }

void expectPassageMean(const SeedMeans& reference, const SeedMeans& found, const std::string& where) {
  const auto difference = [&](size_t s, size_t i) -> std::optional<double> {
    return found.images[s][i] - reference.images[s][i];
  };
  double mean = 0;
  for (const double value : reference.mean) mean += value / static_cast<double>(reference.mean.size());
  const TileStatistics statistics = tileStatistics(reference.width, reference.mean.size(), difference, 0.02 * mean);
  EXPECT_LE(statistics.imageT, 4) << where << ": " << statistics.describe();
}

// Every method on `scene` against path tracing on `reference`.
void expectEveryMethod(const Scene& reference, const Scene& scene, const std::string& where,
                       PathLimits limits = PathLimits()) {
  const auto with = [&](RenderSettings settings) {
    settings.limits = limits;
    return settings;
  };
  const SeedMeans truth = renderSeeds(reference, with(passageSettings(Method::pt)), 2 * passageIterations());
  for (const Method method : {Method::pt, Method::gpt, Method::lt, Method::bpt, Method::vcm}) {
    expectSameTruth(truth, renderSeeds(scene, with(passageSettings(method)), passageIterations(), 5000),
                    std::string(toString(method)) + where);
  }
  for (const Method method : {Method::ppm, Method::bpm}) {
    expectPassageMean(truth, renderSeeds(scene, with(passageSettings(method)), 3 * passageIterations(), 6000),
                      std::string(toString(method)) + where);
  }
  for (size_t k = 0; k < kMetropolisVariantNames.size(); ++k) {
    RenderSettings settings = with(passageSettings(Method::mlt));
    settings.metropolis.variant = static_cast<MetropolisVariant>(k);
    expectSameTruth(truth, renderSeeds(scene, settings, passageIterations(), 7000),
                    std::string(kMetropolisVariantNames[k]) + where);
  }
}

// ---- sheets in a room -----------------------------------------------------------------------------------------------

// A level sheet of side 1.4 in the middle of a room; u and v along x and -z.
Shape& addSheet(Scene& scene, uint32_t material, double u = 0, double v = 0, double side = 1.4) {
  return addShape(scene, Rectangle{{-0.7 + u, 0.1, 0.7 - v}, {side, 0, 0}, {0, 0, -side}}, material);
}

Scene passageRoom(RoomLight light) {
  return roomScene({.light = light, .width = kSheetsWidth, .height = kSheetsHeight});
}

// Two squares of a checkerboard are there and two are not.
Scene leafRoom(RoomLight light) {
  Scene scene = passageRoom(light);
  scene.textures.push_back({.kind = CheckerboardTexture{.color0 = {0, 0, 0}, .color1 = {1, 1, 1}},
                            .toUv = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  const uint32_t leaf = addMaterial(scene, Diffuse{{{0.6, 0.5, 0.4}}}, true);
  scene.materials[leaf].opacity = TexturedFloat{1, static_cast<uint32_t>(scene.textures.size() - 1)};
  addSheet(scene, leaf);
  return scene;
}
Scene cutOutRoom(RoomLight light) {
  Scene scene = passageRoom(light);
  const uint32_t leaf = addMaterial(scene, Diffuse{{{0.6, 0.5, 0.4}}}, true);
  addSheet(scene, leaf, 0, 0.7, 0.7);
  addSheet(scene, leaf, 0.7, 0, 0.7);
  return scene;
}

class PassagesTest : public testing::TestWithParam<RoomLight> {};

TEST_P(PassagesTest, ofALeafAreHolesCutOut) {
  expectEveryMethod(cutOutRoom(GetParam()), leafRoom(GetParam()), ", leaf");
}

INSTANTIATE_TEST_SUITE_P(Engine, PassagesTest,
                         testing::Values(RoomLight::quad, RoomLight::sphere, RoomLight::shell, RoomLight::point,
                                         RoomLight::spot, RoomLight::directional, RoomLight::constant,
                                         RoomLight::envmap),
                         [](const auto& instance) {
                           return std::string(kRoomLightNames[static_cast<size_t>(instance.param)]);
                         });

// What passes is no vertex: the limit of edges is that of the scene without it.
TEST(Passages, countAsNoEdges) {
  for (const uint32_t depth : {2u, 3u}) {
    expectEveryMethod(cutOutRoom(RoomLight::point), leafRoom(RoomLight::point), ", K = " + std::to_string(depth),
                      {.maxDepth = depth});
  }
}

TEST(Passages, onEveryIntersectorAndInDouble) {
  const Scene leaf = leafRoom(RoomLight::spot);
  const SeedMeans truth =
      renderSeeds(cutOutRoom(RoomLight::spot), passageSettings(Method::pt), 2 * passageIterations());
  for (const Accel accel : {Accel::bvh, Accel::embree}) {
    for (const Method method : {Method::pt, Method::gpt, Method::bpt}) {
      expectSameTruth(truth, renderSeeds(leaf, passageSettings(method, accel), passageIterations(), 5000),
                      std::string(toString(method)) + ", accelerator " + std::to_string(static_cast<int>(accel)));
    }
  }
  RenderSettings doubled = passageSettings(Method::bpt);
  doubled.precision = Precision::doubled;
  expectSameTruth(truth, renderSeeds(leaf, doubled, passageIterations(), 5000), "bpt, double");
}

// The sheet as an instance of a group that holds nothing else.
TEST(Passages, ofInstances) {
  Scene leaf = leafRoom(RoomLight::spot);
  leaf.groups.push_back({});
  leaf.shapes.back().group = 0;
  Instance instance;
  instance.group = 0;
  instance.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  leaf.instances.push_back(instance);
  const SeedMeans truth =
      renderSeeds(cutOutRoom(RoomLight::spot), passageSettings(Method::pt), 2 * passageIterations());
  for (const Method method : {Method::pt, Method::gpt, Method::bpt, Method::vcm}) {
    RenderSettings settings = passageSettings(method, Accel::bvh);
    settings.instancing = Instancing::kept;
    expectSameTruth(truth, renderSeeds(leaf, settings, passageIterations(), 5000), std::string(toString(method)));
  }
}

// ---- what lets light through in part --------------------------------------------------------------------------------

// Sheets of each kind that let through a part of the light, in a room with a lamp or a point.
enum class Sheet { mask, blend, tintedBoundary, thinBoundary, metal };
constexpr std::array<const char*, 5> kSheetNames{"mask", "blend", "tintedBoundary", "thinBoundary", "metal"};

uint32_t addSheetMaterial(Scene& scene, Sheet sheet) {
  const uint32_t paper = addMaterial(scene, Diffuse{{{0.6, 0.5, 0.4}}}, true);
  switch (sheet) {
    case Sheet::mask:
      scene.materials[paper].opacity = TexturedFloat{0.4};
      return paper;
    case Sheet::blend: {
      const uint32_t absent = addDiffuse(scene, 0, 0, 0);
      scene.materials[absent].opacity = TexturedFloat{0};
      return addMaterial(scene, Blend{.materials = {absent, paper}, .weights = {0.6, 0.4}});
    }
    case Sheet::tintedBoundary:
      return addMaterial(scene, Dielectric{.intIor = 1.3, .extIor = 1.3, .specularTransmittance = {{0.9, 0.6, 0.3}}});
    case Sheet::thinBoundary:
      return addMaterial(
          scene, Dielectric{.intIor = 1, .extIor = 1, .specularTransmittance = {{0.5, 0.5, 0.5}}, .thin = true});
    case Sheet::metal: {
      const uint32_t metal =
          addMaterial(scene, Conductor{.eta = {1.6, 0.9, 0.5}, .k = {9, 6, 5}, .alpha = {0.4}}, true);
      scene.materials[metal].opacity = TexturedFloat{0.5};
      return metal;
    }
  }
  return paper;
}

class SheetsTest : public testing::TestWithParam<Sheet> {};

// Two sheets, one above the other.
TEST_P(SheetsTest, agreeByEveryMethod) {
  for (const RoomLight light : {RoomLight::quad, RoomLight::point}) {
    Scene scene = passageRoom(light);
    const uint32_t material = addSheetMaterial(scene, GetParam());
    addSheet(scene, material);
    addShape(scene, Rectangle{{-0.5, -0.3, 0.6}, {1.1, 0, 0}, {0, 0.2, -1}}, material);
    const std::string where = std::string(", ") + kRoomLightNames[static_cast<size_t>(light)];
    const SeedMeans truth = renderSeeds(scene, passageSettings(Method::pt), 2 * passageIterations());
    for (const Method method : {Method::gpt, Method::lt, Method::bpt, Method::vcm}) {
      expectSameTruth(truth, renderSeeds(scene, passageSettings(method), passageIterations(), 5000),
                      std::string(toString(method)) + where);
    }
    for (const Method method : {Method::ppm, Method::bpm}) {
      expectPassageMean(truth, renderSeeds(scene, passageSettings(method), 3 * passageIterations(), 6000),
                        std::string(toString(method)) + where);
    }
    for (const MetropolisVariant variant :
         {MetropolisVariant::pssmlt, MetropolisVariant::mmlt, MetropolisVariant::pathspace}) {
      RenderSettings settings = passageSettings(Method::mlt);
      settings.metropolis.variant = variant;
      const bool tinted = GetParam() == Sheet::tintedBoundary || GetParam() == Sheet::thinBoundary;
      if (tinted && variant == MetropolisVariant::pathspace) {
        EXPECT_THROW(Session::create(scene, settings), SceneError);
        continue;
      }
      expectSameTruth(truth, renderSeeds(scene, settings, passageIterations(), 7000),
                      std::string(kMetropolisVariantNames[static_cast<size_t>(variant)]) + where);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, SheetsTest,
                         testing::Values(Sheet::mask, Sheet::blend, Sheet::tintedBoundary, Sheet::thinBoundary,
                                         Sheet::metal),
                         [](const auto& instance) {
                           return std::string(kSheetNames[static_cast<size_t>(instance.param)]);
                         });

// A floor under the sun, under two masks that let through a half and a fifth: known to the last bit but for rounding.
TEST(Passages, multiplyAlongAShadowRay) {
  Scene scene;
  const uint32_t white = addDiffuse(scene, 0.5, 0.5, 0.5);
  addShape(scene, Rectangle{{-9, -1, 9}, {18, 0, 0}, {0, 0, -18}}, white);
  for (const auto& [height, opacity] : {std::pair{2.0, 0.5}, {3.0, 0.8}}) {
    const uint32_t mask = addDiffuse(scene, 0, 0, 0);
    scene.materials[mask].opacity = TexturedFloat{opacity};
    addShape(scene, Rectangle{{-9, height, 9}, {18, 0, 0}, {0, 0, -18}}, mask);
  }
  addEmitter(scene, DirectionalEmitter{{0, -1, 0}, {3, 2, 1}});
  setCamera(scene, {0, 0, 4}, 40, 8, 8);
  scene.sensor.toWorld = {{{-1, 0, 0, 0}, {0, 0.8, -0.6, 0.5}, {0, -0.6, -0.8, 0.5}, {0, 0, 0, 1}}};
  RenderSettings settings = passageSettings(Method::pt);
  settings.limits.maxDepth = 2;
  const RgbImage image = render(scene, settings, 2);
  for (size_t i = 0; i < image.size(); ++i) {
    const double expected = 0.5 / std::numbers::pi * (3 - static_cast<double>(i % 3)) * 0.5 * 0.2;
    EXPECT_NEAR(image[i], expected, 1e-5 * expected) << i;
  }
}

// A lamp that is a mask as well shines as before, and what is behind it is seen through it.
TEST(Passages, ofALampAreADeltaLobe) {
  Scene scene = passageRoom(RoomLight::quad);
  scene.materials[scene.shapes.back().material].opacity = TexturedFloat{0.3};
  const uint32_t material = addSheetMaterial(scene, Sheet::mask);
  addSheet(scene, material);
  const SeedMeans truth = renderSeeds(scene, passageSettings(Method::pt), 2 * passageIterations());
  for (const Method method : {Method::gpt, Method::lt, Method::bpt, Method::vcm}) {
    expectSameTruth(truth, renderSeeds(scene, passageSettings(method), passageIterations(), 5000),
                    std::string(toString(method)));
  }
}

// ---- what costs nothing ---------------------------------------------------------------------------------------------

TEST(Passages, areAFeatureOfTheScene) {
  const auto plan = planRender<float>(passageRoom(RoomLight::quad), passageSettings(Method::bpt));
  EXPECT_EQ(plan.view.passages, nullptr);
  EXPECT_EQ(plan.pipeline.cameraPass().perDepth.front().run, plan.stages->extendSmall);
  const auto through = planRender<float>(leafRoom(RoomLight::quad), passageSettings(Method::bpt));
  EXPECT_NE(through.view.passages, nullptr);
  EXPECT_EQ(through.pipeline.cameraPass().perDepth.front().run, through.stages->extendPassing);
}

}  // namespace
}  // namespace wavecrest
