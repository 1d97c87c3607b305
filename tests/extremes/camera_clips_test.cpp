// Near and far clip: what lies outside is not seen, by any method, and changes no weight.
#include <gtest/gtest.h>

#include "bench/extremes/extreme_scenes.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

RenderSettings settingsOf(Method method) {
  RenderSettings settings;
  settings.method = method;
  settings.isa = bestIsa();
  settings.metropolis.chains = 256;
  settings.metropolis.bootstrapSamples = 8192;
  return settings;
}

double meanOf(const Scene& scene, Method method, uint64_t iterations) {
  const SeedMeans seeds = renderSeeds(scene, settingsOf(method), iterations);
  double sum = 0;
  for (const double value : seeds.mean) sum += value;
  return sum / static_cast<double>(seeds.mean.size());
}

// Two black squares across the picture, 1 and 3 before the camera, under a sky of radiance 1.
Scene twoSquares(double nearClip, double farClip) {
  Scene scene;
  const uint32_t black = addDiffuse(scene, 0, 0, 0);
  for (const double z : {-1.0, -3.0}) {
    addShape(scene, Rectangle{.corner = {-9, -9, z}, .edgeU = {18, 0, 0}, .edgeV = {0, 18, 0}}, black);
  }
  Emitter sky;
  sky.kind = ConstantEmitter{{1, 1, 1}};
  scene.emitters.push_back(sky);
  setCamera(scene, {0, 0, 0}, 60, 8, 8);
  scene.sensor.nearClip = nearClip;
  scene.sensor.farClip = farClip;
  return scene;
}

TEST(CameraClips, hideWhatLiesOutside) {
  for (const Method method : {Method::pt, Method::bpt, Method::vcm}) {
    const std::string name(toString(method));
    EXPECT_EQ(meanOf(twoSquares(0.5, 100), method, 1), 0) << name << ", both";
    EXPECT_EQ(meanOf(twoSquares(2, 100), method, 1), 0) << name << ", the second";
    EXPECT_EQ(meanOf(twoSquares(2, 2.9), method, 1), 1) << name << ", between both";
    EXPECT_EQ(meanOf(twoSquares(0.5, 0.9), method, 1), 1) << name << ", before both";
    EXPECT_EQ(meanOf(twoSquares(3.1, 100), method, 1), 1) << name << ", behind both";
  }
}

// The same squares as boundaries between equal indices, which colour what is seen through them.
Scene twoPanes(double farClip) {
  Scene scene = twoSquares(0.5, farClip);
  Material pane;
  pane.kind = Dielectric{.intIor = 1.3, .extIor = 1.3, .specularTransmittance = {{0.5, 0.5, 0.5}}};
  scene.materials.push_back(pane);
  for (Shape& shape : scene.shapes) shape.material = static_cast<uint32_t>(scene.materials.size() - 1);
  return scene;
}

TEST(CameraClips, hideWhatLightPasses) {
  for (const Method method : {Method::pt, Method::gpt, Method::lt, Method::bpt, Method::vcm, Method::mlt}) {
    const std::string name(toString(method));
    EXPECT_NEAR(meanOf(twoPanes(100), method, 1), 0.25, 1e-5) << name << ", both are seen";
    EXPECT_NEAR(meanOf(twoPanes(2.9), method, 1), 0.5, 1e-5) << name << ", the second is hidden";
    EXPECT_NEAR(meanOf(twoPanes(0.9), method, 1), 1, 1e-5) << name << ", both are hidden";
  }
  for (const Sensor::Kind kind : {Sensor::Kind::orthographic, Sensor::Kind::thinlens}) {
    Scene scene = twoPanes(2.9);
    scene.sensor.kind = kind;
    scene.sensor.apertureRadius = 0.1;
    scene.sensor.focusDistance = 1;
    EXPECT_NEAR(meanOf(scene, Method::pt, 1), 0.5, 1e-5);
  }
}

// Planes, not spheres: a square at the corner of the picture is farther away, and clipped where its middle is.
TEST(CameraClips, arePlanes) {
  EXPECT_EQ(meanOf(twoSquares(0.99, 1.01), Method::pt, 1), 0);
  EXPECT_EQ(meanOf(twoSquares(1.01, 2.99), Method::pt, 1), 1);
}

// Behind the focus a lens sees what is far beside the frustum of its middle.
TEST(CameraClips, hideWhatOnlyTheRimOfALensSees) {
  Scene scene = twoSquares(1, 100);
  scene.shapes.resize(1);
  scene.shapes[0].kind = Rectangle{.corner = {0.9, -0.5, -0.9}, .edgeU = {0.4, 0, 0}, .edgeV = {0, 1, 0}};
  scene.sensor.kind = Sensor::Kind::thinlens;
  scene.sensor.apertureRadius = scene.sensor.focusDistance = 0.1;
  EXPECT_EQ(meanOf(scene, Method::pt, 4), 1);
  scene.sensor.nearClip = 0.5;
  EXPECT_LT(meanOf(scene, Method::pt, 4), 1) << "the square is seen";
}

TEST(CameraClips, cutParallelRays) {
  Scene scene = twoSquares(2, 2.9);
  scene.sensor.kind = Sensor::Kind::orthographic;
  EXPECT_EQ(meanOf(scene, Method::pt, 1), 1);
  scene.sensor.farClip = 100;
  EXPECT_EQ(meanOf(scene, Method::pt, 1), 0);
}

// Light passes a wall before the near clip as if it were not there, yet is reflected by it: from within the lamp's box
// the wall behind the near clip is seen through by all methods alike.
TEST(CameraClips, changeNoWeight) {
  Scene scene = lampBox({});
  Shape shade;
  shade.kind = Rectangle{.corner = {-0.2, -0.2, 0.8}, .edgeU = {0.4, 0, 0}, .edgeV = {0, 0.4, 0}};
  shade.material = 0;
  scene.shapes.push_back(shade);
  scene.sensor.nearClip = 0.4;
  const double expected = meanOf(scene, Method::pt, 48);
  for (const Method method : {Method::lt, Method::bpt, Method::vcm}) {
    // Four standard errors of such means, measured.
    EXPECT_NEAR(meanOf(scene, method, 12) / expected, 1, 0.06) << toString(method);
  }
}

TEST(CameraClips, areRefusedInPathSpace) {
  RenderSettings settings = settingsOf(Method::mlt);
  settings.metropolis.variant = MetropolisVariant::pathspace;
  EXPECT_THROW(Session::create(twoSquares(2, 100), settings), std::runtime_error);
  EXPECT_NO_THROW(Session::create(twoSquares(0.5, 100), settings));
}

}  // namespace
}  // namespace wavecrest
