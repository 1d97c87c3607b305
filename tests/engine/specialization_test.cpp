// Specialised kernels give the image of the complete ones: what a feature set lacks must cost nothing and change
// nothing.
#include <gtest/gtest.h>

#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kImageWidth = 48, kImageHeight = 36;
constexpr uint64_t kTwoIterations = 2;

class SpecializationTest : public testing::TestWithParam<Variant> {
 protected:
  // Renders with each specialisation that covers the scene and compares with `complete`. The same paths are traced, so
  // pixels differ by rounding only; a path whose roulette or edge is decided by rounding may differ, at most one pixel
  // in a thousand.
  void expectSameImages(const Scene& scene, std::initializer_list<Specialization> list, Method method = Method::pt) {
    RenderSettings settings = settingsFor(GetParam());
    settings.method = method;
    settings.specialization = Specialization::complete;
    const RgbImage complete = render(scene, settings, kTwoIterations);
    for (const Specialization specialization : list) {
      if (!isCompiled(GetParam().precision, specialization)) continue;
      settings.specialization = specialization;
      const auto session = Session::create(scene, settings);
      session->renderUntil(kTwoIterations, std::nullopt);
      EXPECT_EQ(session->statistics().specialization, specialization) << "the forced kernels ran";
      const RgbImage image = session->film().resolve();
      size_t different = 0;
      for (size_t i = 0; i < image.size(); ++i) {
        different += std::abs(image[i] - complete[i]) > 1e-5f + 1e-4f * std::abs(complete[i]) ? 1 : 0;
      }
      EXPECT_LE(different, image.size() / 1000) << kSpecializationNames[static_cast<size_t>(specialization)];
    }
  }
};

TEST_P(SpecializationTest, diffuseSceneByEveryKernel) {
  const Scene scene = sceneFile("cornell-diffuse", kImageWidth, kImageHeight);
  expectSameImages(scene, {Specialization::diffuse, Specialization::smooth, Specialization::plain});
  expectSameImages(
      scene,
      {Specialization::diffuseBidirectional, Specialization::smoothBidirectional, Specialization::plainBidirectional},
      Method::bpt);
}

void addLensAndFilter(Scene& scene) {
  scene.sensor.kind = Sensor::Kind::thinlens;
  scene.sensor.apertureRadius = 0.1;
  scene.sensor.focusDistance = 3;
  scene.film.filter = ReconstructionFilter::gaussian;
}

// Cameras and filters are branches that a whole scene takes or not.
TEST_P(SpecializationTest, diffuseSceneThroughALensByTheDiffuseKernels) {
  Scene scene = sceneFile("cornell-diffuse", kImageWidth, kImageHeight);
  addLensAndFilter(scene);
  expectSameImages(scene, {Specialization::diffuse});
  expectSameImages(scene, {Specialization::diffuseBidirectional}, Method::bpt);
}

TEST_P(SpecializationTest, specularSceneByTheKernelsThatCoverIt) {
  expectSameImages(sceneFile("cornell-mirror", kImageWidth, kImageHeight), {Specialization::smooth});
  expectSameImages(sceneFile("validation/furnace-glass", kImageWidth, kImageHeight), {Specialization::smooth});
}

// Sun, sky, a lens, a Gaussian filter and layered materials.
TEST_P(SpecializationTest, plainSceneByTheKernelsThatCoverIt) {
  Scene scene = roomScene(
      {.light = RoomLight::envmap, .materials = RoomMaterials::mixed, .width = kImageWidth, .height = kImageHeight});
  addRoomLight(scene, RoomLight::directional);
  addLensAndFilter(scene);
  expectSameImages(scene, {Specialization::plain});
  expectSameImages(scene, {Specialization::plainBidirectional}, Method::bpt);
}

INSTANTIATE_TEST_SUITE_P(PathTracing, SpecializationTest, testing::ValuesIn(allVariants()),
                         [](const auto& instance) { return nameOf(instance.param); });

TEST(Specialization, isTheFirstThatCoversTheScene) {
  const auto chosen = [](const std::string& scene) {
    return Session::create(sceneFile(scene, 8, 8), {})->statistics().specialization;
  };
  EXPECT_EQ(chosen("cornell-diffuse"), Specialization::diffuse);
  EXPECT_EQ(chosen("cornell-mirror"), Specialization::smooth);
  EXPECT_EQ(chosen("validation/furnace-sphere"), Specialization::smooth);
  EXPECT_EQ(chosen("cornell-spheres"), Specialization::plain);
}

// Whatever else a scene has: without textures and shading normals it does not pay for them.
TEST(Specialization, hasTexturesAndShadingNormalsOnlyWhereTheSceneDoes) {
  constexpr uint32_t kDear = kTextures | kShadingNormals | kNormalMaps;
  if (!isCompiled(Precision::floating, Specialization::plain)) GTEST_SKIP() << "only the complete kernels are compiled";
  for (uint32_t features = 0; features < kCompoundBsdfs; ++features) {
    const uint32_t chosen = featuresOf(chooseSpecialization(features, Precision::floating));
    EXPECT_EQ((chosen & kDear) != 0, (features & kDear) != 0) << features;
    EXPECT_EQ(features & ~chosen, 0u) << features;
  }
}

// What few scenes have is in no set but the last, which has everything.
TEST(Specialization, isCompleteForCompoundBsdfsAndInstances) {
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const uint32_t feature : {uint32_t{kCompoundBsdfs}, uint32_t{kInstances}}) {
      EXPECT_EQ(chooseSpecialization(feature, precision), Specialization::complete);
    }
  }
  EXPECT_EQ(featuresOf(Specialization::complete), kAllFeatures);
}

TEST(Specialization, thatDoesNotCoverTheSceneIsRefused) {
  RenderSettings settings;
  settings.specialization = Specialization::diffuse;
  EXPECT_THROW(Session::create(sceneFile("cornell-mirror", 8, 8), settings), std::runtime_error);
  EXPECT_THROW(Session::create(sceneFile("validation/closed-sphere", 8, 8), settings), std::runtime_error);
}

// A wave of the plainest kernels, as the session runs it: 2048 paths in 256 kB.
TEST(Specialization, diffuseWaveTakesAtMost128BytesPerPath) {
  const Scene scene = sceneFile("cornell-diffuse", 16, 16);
  const auto session = Session::create(scene, {});
  session->renderUntil(1, std::nullopt);
  const RenderStatistics statistics = session->statistics();
  EXPECT_EQ(statistics.specialization, Specialization::diffuse);
  EXPECT_GT(statistics.bytesPerPath, 0u);
  EXPECT_LE(statistics.bytesPerPath, 128u);
}

}  // namespace
}  // namespace wavecrest
