// Light of a colour outside of Rec. 709 has negative channels. They are kept by every strategy, also where a surface
// reflects no other channel.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 16;

// Whatever reflects all light is as bright as the sky around.
void expectMinusHalfInBlue(bool walls, Method method) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.method = method;
  settings.radius = 0.02;
  expectTruth(
      renderSeeds(wideGamutScene(walls, kSide, kSide), settings, 16),
      [](uint32_t, uint32_t, size_t c) -> std::optional<double> { return c == 2 ? -0.5 : 0.0; },
      std::string(toString(method)));
}

TEST(WideGamutLight, areKeptOnAFloor) {
  for (const Method method : {Method::pt, Method::lt, Method::bpt, Method::ppm}) expectMinusHalfInBlue(false, method);
}

TEST(WideGamutLight, areKeptWhereLightIsReflectedSeveralTimes) {
  for (const Method method : {Method::pt, Method::lt, Method::bpt}) expectMinusHalfInBlue(true, method);
}

}  // namespace
}  // namespace wavecrest
