// Light of a colour outside of Rec. 709 has negative channels. They are kept by every strategy, also where a surface
// reflects no other channel.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 16;
constexpr Matrix4 kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

// A floor under an even sky of radiance (1, 1, -0.5), which reflects all blue and nothing else. The camera above sees
// the floor's middle alone. With walls it is a box that is open above, of the same material.
Scene floorScene(bool walls) {
  Scene scene;
  scene.name = "floor";
  const uint32_t blue = addDiffuse(scene, 0, 0, 1);
  addShape(scene, Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, blue);
  if (walls) {  // facing inwards
    addShape(scene, Rectangle{{-1, -1, 0}, {0, 2, 0}, {0, 0, 1}}, blue);
    addShape(scene, Rectangle{{1, -1, 0}, {0, 0, 1}, {0, 2, 0}}, blue);
    addShape(scene, Rectangle{{-1, -1, 0}, {0, 0, 1}, {2, 0, 0}}, blue);
    addShape(scene, Rectangle{{-1, 1, 0}, {2, 0, 0}, {0, 0, 1}}, blue);
  }
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = bitmap->height = 1;
  bitmap->pixels = {1, 1, -0.5f};
  addEmitter(scene, EnvmapEmitter{.bitmap = bitmap, .toWorld = kIdentity});
  setCamera(scene, {0, 0, 3}, 25, kSide, kSide);
  return scene;
}

// Whatever reflects all light is as bright as the sky around.
void expectMinusHalfInBlue(bool walls, Method method) {
  RenderSettings settings = settingsFor({Precision::floating, SamplerKind::independent, Accel::small});
  settings.method = method;
  settings.radius = 0.02;
  expectTruth(
      renderSeeds(floorScene(walls), settings, 16),
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
