// The pictures that methods make of instances in a hierarchy of two levels, against those of copies: the same but for
// noise (render_statistics.h).
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/engine/instanced_scenes.h"
#include "tests/engine/metropolis_settings.h"

namespace wavecrest {
namespace {

// Three bodies of glass, brushed metal and a texture with a bump in a room: mirrored, stretched and sheared.
Scene furnishedRoom() {
  Scene scene = roomScene({.light = RoomLight::quad, .width = kWidth, .height = kHeight});
  scene.groups.push_back({.id = "bodies", .source = {}});
  scene.textures.push_back(
      {.kind = CheckerboardTexture{}, .toUv = {{{6, 0, 0, 0}, {0, 6, 0, 0}, {0, 0, 6, 0}, {0, 0, 0, 1}}}});
  const auto texture = static_cast<uint32_t>(scene.textures.size() - 1);
  const uint32_t glass = addMaterial(scene, Dielectric{.intIor = 1.5, .extIor = 1});
  Conductor brushed;
  brushed.alpha.value = 0.4;
  brushed.alphaV = TexturedFloat{0.2};
  const uint32_t metal = addMaterial(scene, brushed, true);
  const uint32_t bumpy = addMaterial(scene, Diffuse{{{0.5, 0.5, 0.5}, texture}}, true);
  scene.materials[bumpy].bumpTexture = texture;
  scene.materials[bumpy].bumpScale = 0.01;
  addShape(scene, ballMesh({10, 0, 0}, 0.25, 8), glass).group = 0;
  addShape(scene, ballMesh({10.3, 0.3, -0.2}, 0.2, 8), metal).group = 0;
  addShape(scene, Rectangle{{9.6, -0.3, -0.4}, {0.5, 0, 0}, {0, 0.5, 0.1}}, bumpy).group = 0;
  addInstance(scene, 0, placedAt({9.5, -0.6, 0.3}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  addInstance(scene, 0, placedAt({0.4 - 6, -0.5, -0.2}, {{0.6, 0, 0}, {0, 1.2, 0}, {0, 0, 1}}));
  addInstance(scene, 0, placedAt({-5, 0.3 + 2, 0}, {{0.5, -0.2, 0.1}, {0.1, 0.6, 0}, {0, 0.2, -0.8}}));
  return scene;
}

RenderSettings settingsOfInstances(Method method, Instancing instancing) {
  RenderSettings settings = defaults();
  settings.method = method;
  settings.accel = Accel::bvh;
  settings.instancing = instancing;
  settings.radius = 0.01;
  return settings;
}

class InstanceImagesTest : public testing::TestWithParam<Method> {};

TEST_P(InstanceImagesTest, areThoseOfCopies) {
  const Scene scene = furnishedRoom();
  const uint64_t count = GetParam() == Method::mlt ? samples(64, 16) : samples(16, 4);
  const SeedMeans kept = renderSeeds(scene, settingsOfInstances(GetParam(), Instancing::kept), count, 1000);
  const SeedMeans copied = renderSeeds(scene, settingsOfInstances(GetParam(), Instancing::expanded), count, 2000);
  expectSameTruth(kept, copied, std::string(toString(GetParam())));
}
// Chains of paths trace their vertices anew.
TEST(InstanceImages, ofPathSpaceAreThoseOfCopies) {
  const Scene scene = furnishedRoom();
  RenderSettings kept = settingsOfInstances(Method::mlt, Instancing::kept),
                 copied = settingsOfInstances(Method::mlt, Instancing::expanded);
  kept.metropolis.variant = copied.metropolis.variant = MetropolisVariant::pathspace;
  expectSameTruth(renderSeeds(scene, kept, samples(64, 16), 1000), renderSeeds(scene, copied, samples(64, 16), 2000),
                  "pathspace");
}

INSTANTIATE_TEST_SUITE_P(Engine, InstanceImagesTest,
                         testing::Values(Method::pt, Method::lt, Method::bpt, Method::mlt, Method::ppm, Method::bpm,
                                         Method::vcm, Method::gpt),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

// The same picture whatever the threads and waves, in every precision.
TEST(InstanceImages, doNotDependOnThreadsAndWaves) {
  const Scene scene = furnishedRoom();
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    RenderSettings settings = settingsOfInstances(Method::pt, Instancing::kept);
    settings.precision = precision;
    settings.threads = 1;
    settings.waveSize = 4096;
    const RgbImage one = render(scene, settings, 2);
    settings.threads = 2;
    settings.waveSize = 256;
    EXPECT_EQ(render(scene, settings, 2), one) << kPrecisionNames[static_cast<size_t>(precision)];
  }
}

}  // namespace
}  // namespace wavecrest
