// Shadow rays are not blocked by the surface at their end, where that lies closer to the coordinates' origin than they
// are long: then they round by more than the coordinates of that surface do.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

RenderSettings settingsOf(Method method, Precision precision, Accel accel, Isa isa, uint32_t edges) {
  RenderSettings settings = settingsFor({precision, SamplerKind::independent, accel});
  settings.method = method;
  settings.isa = isa;
  settings.limits.maxDepth = edges;
  return settings;
}

// ---- a lamp in the plane y = 0 --------------------------------------------------------------------------------------

// At this height the way to the lamp is a float whose product with its rounded reciprocal is less than 1.
constexpr double kHeight = 41.00003814697265625;
constexpr double kAlbedo = 0.7, kRadiance = 100;

// A square lamp about the origin, and a camera half way below it that looks down at the floor.
Scene lampAboveFloor() {
  Scene scene;
  const uint32_t grey = addDiffuse(scene, kAlbedo, kAlbedo, kAlbedo);
  addShape(scene, Rectangle{{-20, -kHeight, 20}, {40, 0, 0}, {0, 0, -40}}, grey);
  addShape(scene, Rectangle{{-0.25, 0, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}}, addDiffuse(scene, 0, 0, 0));
  makeLight(scene, {kRadiance, kRadiance, kRadiance});
  setCamera(scene, {0, -20, 0}, 40, 8, 8);
  scene.sensor.toWorld = {{{-1, 0, 0, 0}, {0, 0, -1, -20}, {0, -1, 0, 0}, {0, 0, 0, 1}}};
  return scene;
}

// The sum over all pixels and channels: of a lamp that is small for its distance.
double sumBelowLamp() {
  constexpr double kArea = 0.25;
  const double pixel = 2 * (kHeight - 20) * std::tan(20 * std::numbers::pi / 180) / 8;  // on the floor
  double sum = 0;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double x = (column - 3.5) * pixel, z = (row - 3.5) * pixel;
      const double dist2 = x * x + z * z + kHeight * kHeight;
      sum += 3 * kAlbedo / std::numbers::pi * kRadiance * kArea * kHeight * kHeight / (dist2 * dist2);
    }
  }
  return sum;
}

TEST(ShadowEnds, areClearOfALampAcrossTheOrigin) {
  const Scene scene = lampAboveFloor();
  const double expected = sumBelowLamp();
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const Accel accel : {Accel::small, Accel::bvh, Accel::embree}) {
      if (accel == Accel::embree && precision == Precision::doubled) continue;
      for (const Isa isa : availableIsas()) {
        const double sum = sumOf(render(scene, settingsOf(Method::pt, precision, accel, isa, 2), 4));
        // Samples differ from pixel centres, and by less than 10 % from each other: the mean of 256 by 0.2 %.
        EXPECT_NEAR(sum, expected, 0.02 * expected) << kPrecisionNames[static_cast<size_t>(precision)] << ", "
                                                    << kAccelNames[static_cast<size_t>(accel)] << ", " << toString(isa);
      }
    }
  }
}

// ---- small things at the origin -------------------------------------------------------------------------------------

// Where coordinates are as large as shadow rays are long, offsets that follow from coordinates suffice.
constexpr Double3 kElsewhere{0.9, 0.7, 0.8};

// A wall one unit behind the point `at`, and a camera between them that sees nothing else.
Scene wallBehind(const Double3& at) {
  Scene scene;
  const uint32_t grey = addDiffuse(scene, 0.7, 0.7, 0.7);
  addShape(scene, Rectangle{at + Double3{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, grey);
  setCamera(scene, at + Double3{0.3, 0.2, -0.15}, 60, 8, 8);
  return scene;
}
// A square about `at` that is parallel to no axis and faces the wall.
Rectangle turnedSquare(const Double3& at, double side) {
  const Double3 normal = normalized({0.3, 0.2, -0.9});
  const Double3 x = normalized(cross({0, 1, 0}, normal)), y = cross(normal, x);
  return {.corner = at - (x + y) * (side / 2), .edgeU = x * side, .edgeV = y * side};
}

// As much light arrives as in the same scene elsewhere, whatever the intersector.
void expectSameLight(const std::function<Scene(const Double3&)>& sceneAt, RenderSettings settings,
                     const std::string& what) {
  constexpr uint64_t kIterations = 16;
  const double expected = sumOf(render(sceneAt(kElsewhere), settings, kIterations));
  ASSERT_GT(expected, 0) << what;
  for (const Accel accel : {Accel::small, Accel::bvh, Accel::embree}) {
    settings.accel = accel;
    const double sum = sumOf(render(sceneAt({0, 0, 0}), settings, kIterations));
    // The same numbers choose the same paths, but where rounding decides.
    EXPECT_NEAR(sum, expected, 0.03 * expected) << what << ", " << kAccelNames[static_cast<size_t>(accel)];
  }
}

TEST(ShadowEnds, areClearOfSmallLampsAtTheOrigin) {
  const RenderSettings settings = settingsOf(Method::pt, Precision::floating, Accel::bvh, bestIsa(), 2);
  for (const double side : {1e-1, 1e-3, 1e-5}) {
    const double radiance = 1 / (side * side);
    const auto withLamp = [&](const Double3& at, const auto& lamp) {
      Scene scene = wallBehind(at);
      addShape(scene, lamp, addDiffuse(scene, 0, 0, 0));
      makeLight(scene, {radiance, radiance, radiance});
      return scene;
    };
    const auto square = [&](const Double3& at) { return withLamp(at, turnedSquare(at, side)); };
    const auto sphere = [&](const Double3& at) { return withLamp(at, Sphere{.center = at, .radius = side / 2}); };
    expectSameLight(square, settings, "square of side " + std::to_string(side));
    expectSameLight(sphere, settings, "sphere of diameter " + std::to_string(side));
  }
}

// A spot lights a small square, which alone lights the wall: mostly by connections of its vertices with the wall's.
TEST(ShadowEnds, areClearOfSmallReflectorsAtTheOrigin) {
  constexpr double kSide = 0.006;
  const auto sceneAt = [&](const Double3& at) {
    Scene scene = wallBehind(at);
    addShape(scene, turnedSquare(at, kSide), addDiffuse(scene, 0.9, 0.9, 0.9));
    const Double3 towardsSpot{0.5, 0.6, -0.6};
    // The beam is 0.0034 wide where it meets the square.
    addEmitter(scene, SpotEmitter{.position = at + towardsSpot,
                                  .direction = normalized(towardsSpot * -1.0),
                                  .intensity = {1e6, 1e6, 1e6},
                                  .cutoffAngle = 0.1,
                                  .beamWidth = 0.07});
    return scene;
  };
  RenderSettings settings = settingsOf(Method::bpt, Precision::floating, Accel::bvh, bestIsa(), 3);
  settings.connectionRoulette = 0;  // noise, and none with Accel::small
  expectSameLight(sceneAt, settings, "connections");
  settings.method = Method::mlt;
  settings.metropolis.variant = MetropolisVariant::pathspace;
  settings.metropolis.chains = 512;
  settings.metropolis.bootstrapSamples = 16384;
  expectSameLight(sceneAt, settings, "joints of paths");
}

}  // namespace
}  // namespace wavecrest
