// Light tracing has as many light walks to a camera walk as the error of either deserves, and the same image on
// average.
#include "engine/pilot/walk_balance.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/pilot/finished_plan.h"
#include "engine/session/session.h"
#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

constexpr uint32_t kBalanceWidth = 200, kBalanceHeight = 150;
constexpr size_t kBalancePixels = size_t{kBalanceWidth} * kBalanceHeight;

RenderSettings balanceSettings(Method method, bool balanced = true) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.balancedWalks = balanced;
  settings.limits = pathLimits(8, 5);
  return settings;
}

size_t lightPathsOf(const char* scene, const RenderSettings& settings) {
  return Session::create(sceneFile(scene, kBalanceWidth, kBalanceHeight), settings)->memoryPlan().lightPaths;
}

TEST(WalkBalance, viewsWithoutNoiseGetTheFewestCameraWalks) {
  // Nothing in view is specular: all that camera walks find is the lamp, whose edges no pixel of the pilot has.
  EXPECT_EQ(lightPathsOf("cornell-diffuse", balanceSettings(Method::lt)), kMostLightWalks * kBalancePixels);
  EXPECT_EQ(lightPathsOf("cornell-mirror", balanceSettings(Method::lt)), kBalancePixels);
  EXPECT_EQ(lightPathsOf("cornell-diffuse", balanceSettings(Method::lt, false)), kBalancePixels);
  EXPECT_EQ(lightPathsOf("cornell-diffuse", balanceSettings(Method::bpt)), kBalancePixels);
}

TEST(WalkBalance, dependsNeitherOnSeedsNorOnThreadsNorOnWaves) {
  RenderSettings other = balanceSettings(Method::lt);
  const size_t wanted = lightPathsOf("cornell-spheres", other);
  other.seed = 99;
  other.threads = 3;
  other.waveSize = 300;
  EXPECT_EQ(lightPathsOf("cornell-spheres", other), wanted);
}

// A coated wall fills the view. Its coat reflects the wall behind the camera, which gets light from the coated wall
// alone. So both walks find light in every pixel, and most of the light and of the noise is that of light walks.
Scene coatedWall(uint32_t side) {
  Scene scene;
  const uint32_t coated = addMaterial(scene, Plastic{.intIor = 2.5}), diffuse = addDiffuse(scene, 0.8, 0.8, 0.8);
  addShape(scene, Rectangle{{-5, -5, -2}, {10, 0, 0}, {0, 10, 0}}, coated);    // facing +z
  addShape(scene, Rectangle{{20, -20, 3}, {-40, 0, 0}, {0, 40, 0}}, diffuse);  // facing -z
  addEmitter(scene, SpotEmitter{.position = {0, 0.5, 0},
                                .direction = {0, 0, -1},
                                .intensity = {1, 1, 1},
                                .cutoffAngle = 60,
                                .beamWidth = 50});
  setCamera(scene, {0, 0, 0}, 60, side, side);
  return scene;
}

// Small films leave cells without pixels.
TEST(WalkBalance, isThatOfTheSceneOnFilmsOfAnySize) {
  for (const uint32_t side : {1u, 8u, 24u, 64u}) {
    EXPECT_EQ(planMemory(coatedWall(side), balanceSettings(Method::lt)).lightPaths,
              size_t{kMostLightWalks} * side * side)
        << side;
  }
}

// The light that reaches the film together, of equal numbers of light paths, differs by its noise alone.
TEST(WalkBalance, changesNoMean) {
  constexpr uint64_t kBalanceIterations = effort(32, 2);
  const Scene scene = sceneFile("cornell-diffuse", kBalanceWidth, kBalanceHeight);
  const auto brightness = [&](bool balanced, uint64_t iterations) {
    const auto session = Session::create(scene, balanceSettings(Method::lt, balanced));
    session->renderUntil(iterations, {});
    EXPECT_EQ(session->statistics().lightPaths, kBalanceIterations * kMostLightWalks * kBalancePixels);
    const std::vector<float> image = session->film().resolve();
    return std::accumulate(image.begin(), image.end(), 0.0) / static_cast<double>(image.size());
  };
  // 3,840,000 light paths each, which make a splat or two that are about as bright as the image: 0.1 % with the lamp's
  // edges, which 32 camera walks see. Five of these for both, rounded up; of a sixteenth of the paths four times as
  // much.
  EXPECT_NEAR(brightness(true, kBalanceIterations) / brightness(false, kBalanceIterations * kMostLightWalks), 1,
              kFullSpeed ? 0.01 : 0.04);
}

}  // namespace
}  // namespace wavecrest
