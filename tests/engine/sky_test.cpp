// The sky and sun before they are rendered: the model's values, and the map and disc that are made of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/compile/sky.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

constexpr Matrix4 kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
constexpr Matrix4 kUpIsY{{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}};  // z to y

const double kSunElevation = std::asin(0.8);

void expectNear(const Rgb& value, const Rgb& expected, double relative) {
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], relative * expected[c]) << "channel " << c;
}

// Printed by Mitsuba 3.9.1 in float, whose tables and steps are the same: 1e-4 is far above its rounding.
TEST(Sky, HasTheRadianceThatMitsubaHas) {
  const struct {
    Double3 direction;
    Rgb radiance;
  } cases[] = {{{0.3, 0.2, 0.9}, {0.102131, 0.131141, 0.192618}},
               {{-0.5, 0.1, 0.2}, {0.0512792, 0.111809, 0.226102}},
               {{0, 1, 0}, {0.125481, 0.171419, 0.217056}}};
  for (const auto& each : cases) {
    const Double3 d = normalized(each.direction);
    const double sunAngle = std::acos(dot(d, {0.6, 0, 0.8}));
    expectNear(skyRadiance(4.5, {0.2, 0.5, 0.8}, kSunElevation, d[2], sunAngle), each.radiance, 1e-4);
  }
  expectNear(sunIrradiance(4.5, kSunElevation), {1.41884, 1.17359, 0.89167}, 1e-4);
}

SunskyEmitter sunskyOf(const Double3& sun, const Matrix4& toWorld) {
  return {.turbidity = 4.5, .albedo = {0.2, 0.5, 0.8}, .sunDirection = sun, .toWorld = toWorld};
}

// The texel whose centre is nearest to a direction of the world.
Rgb texelAt(const EnvironmentView& map, const Double3& d) {
  Double3 local{};
  for (size_t i = 0; i < 3; ++i) {
    local[i] = map.toLocal[i][0] * d[0] + map.toLocal[i][1] * d[1] + map.toLocal[i][2] * d[2];
  }
  double u = std::atan2(local[0], -local[2]) / (2 * std::numbers::pi);
  u -= std::floor(u);
  const auto column = static_cast<size_t>(u * map.width);
  const auto row = static_cast<size_t>(std::lround(std::acos(local[1]) / std::numbers::pi * (map.height - 1)));
  const float* const texel = map.texels + 3 * (row * map.width + column);
  return {texel[0], texel[1], texel[2]};
}

TEST(Sky, IsBakedAsItsTransformTurnsIt) {
  const Double3 direction = normalized({0.3, 0.2, 0.9});
  const Environment plain = compileSky(sunskyOf({0.6, 0, 0.8}, kIdentity));
  expectNear(texelAt(plain.view, direction), {0.102131, 0.131141, 0.192618}, 0.01);  // texels: 0.7 x 0.09 degrees
  const Environment turned = compileSky(sunskyOf(transformVector(kUpIsY, {0.6, 0, 0.8}), kUpIsY));
  expectNear(texelAt(turned.view, transformVector(kUpIsY, direction)), {0.102131, 0.131141, 0.192618}, 0.01);
}

TEST(Sky, SunIsADiscOfItsIrradiance) {
  const Environment sky = compileSky(sunskyOf({0.6, 0, 0.8}, kIdentity));
  EXPECT_TRUE(sky.view.isSky);
  const double solidAngle = 2 * std::numbers::pi * (1 - std::cos(0.5 * 0.5358 * std::numbers::pi / 180));
  expectNear(solidAngle * Rgb{sky.view.sunRadiance[0], sky.view.sunRadiance[1], sky.view.sunRadiance[2]},
             {1.41884, 1.17359, 0.89167}, 1e-4);
  EXPECT_GT(sky.view.sunShare, 0.1f);
  EXPECT_LT(sky.view.sunShare, 0.9f);
}

TEST(Sky, PartsCanBeLeftOut) {
  SunskyEmitter sunsky = sunskyOf({0.6, 0, 0.8}, kIdentity);
  sunsky.sunScale = 0;
  EXPECT_EQ(compileSky(sunsky).view.sunShare, 0.0f);
  sunsky.sunScale = 1;
  sunsky.skyScale = 0;
  EXPECT_EQ(compileSky(sunsky).view.sunShare, 1.0f);
}

TEST(Sky, IsBlackWithoutASun) {
  const Environment night = compileSky(sunskyOf({0.6, 0, -0.8}, kIdentity));
  EXPECT_EQ(night.meanLuminance, 0);
  EXPECT_EQ(night.view.sunShare, 0.0f);
}

}  // namespace
}  // namespace wavecrest
