// Small rooms for the comparison of methods: one kind of light in each, and a choice of materials.
//
// The room is open to the camera's side, so that infinite lights get in, and about two units wide. Its floor is given
// as a mesh, so that it can have vertex normals.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "engine/scene/vector_math.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {

// shell: a sphere around everything that shines inwards. slide: a spot with a texture. projector: with one, too.
enum class RoomLight { quad, mesh, sphere, shell, point, spot, directional, constant, envmap, slide, projector };
constexpr std::array<const char*, 11> kRoomLightNames{"quad",        "mesh",     "sphere", "shell", "point",    "spot",
                                                      "directional", "constant", "envmap", "slide", "projector"};

constexpr bool isDelta(RoomLight light) {
  return light == RoomLight::point || light == RoomLight::spot || light == RoomLight::directional ||
         light == RoomLight::slide || light == RoomLight::projector;
}

// diffuse: all walls. mixed: a mirror, a glass and a plastic ball, a glossy and a Phong wall. rough: the same room
// without delta lobes, so that every method makes all of its paths whatever the light.
enum class RoomMaterials { diffuse, mixed, rough };

struct Room {
  RoomLight light = RoomLight::quad;
  RoomMaterials materials = RoomMaterials::diffuse;
  bool tiltedNormals = false;  // the floor's shading normals lean
  uint32_t width = 24, height = 18;
};

template <class Kind>
uint32_t addMaterial(Scene& scene, const Kind& kind, bool twoSided = false) {
  Material material;
  material.kind = kind;
  material.twoSided = twoSided;
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

template <class Kind>
void addEmitter(Scene& scene, const Kind& kind) {
  Emitter emitter;
  emitter.kind = kind;
  scene.emitters.push_back(emitter);
}

// A picture of 4 x 3 pixels in several colours, none of them black.
inline uint32_t addPicture(Scene& scene) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 4;
  bitmap->height = 3;
  for (uint32_t i = 0; i < 4 * 3; ++i) {
    for (const uint32_t step : {3u, 5u, 7u}) bitmap->pixels.push_back(0.2f + static_cast<float>(i * step % 8) / 8);
  }
  scene.textures.push_back({.kind = BitmapTexture{.bitmap = bitmap, .wrap = Wrap::clamp},
                            .toUv = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

// Smooth waves of 16 x 16 pixels, 0 to 1.
inline float waveHeight(uint32_t x, uint32_t y) {
  return 0.5f + 0.5f * std::sin(0.8f * static_cast<float>(x)) * std::cos(0.4f * static_cast<float>(y));
}
inline uint32_t addWaves(Scene& scene) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = bitmap->height = 16;
  bitmap->channels = 1;
  for (uint32_t i = 0; i < 16 * 16; ++i) bitmap->pixels.push_back(waveHeight(i % 16, i / 16));
  scene.textures.push_back(
      {.kind = BitmapTexture{.bitmap = bitmap}, .toUv = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

// Of a light in the right front corner at half height that looks at the left back corner, a little downwards.
constexpr Matrix4 kFromTheCorner{
    {{-0.79027, -0.12445, -0.6, 0.6}, {0, 0.97917, -0.2031, 0.3}, {0.61277, -0.1605, -0.7738, 0.8}, {0, 0, 0, 1}}};

inline void addRoomLight(Scene& scene, RoomLight light) {
  const uint32_t black = addDiffuse(scene, 0, 0, 0);
  switch (light) {
    case RoomLight::quad:
      addShape(scene, Rectangle{{-0.3, 0.9, -0.2}, {0.6, 0, 0}, {0, 0, 0.5}}, black);  // facing down
      makeLight(scene, {6, 5, 4});
      break;
    case RoomLight::mesh: {
      Mesh mesh;
      mesh.positions = {{-0.4f, 0.9f, -0.3f}, {0.4f, 0.8f, -0.3f}, {0.0f, 0.9f, 0.4f}, {0.5f, 0.7f, 0.4f}};
      mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
      addShape(scene, mesh, black);
      makeLight(scene, {6, 5, 4});
      break;
    }
    case RoomLight::sphere:
      addShape(scene, Sphere{.center = {0.2, 0.55, 0.1}, .radius = 0.15}, black);
      makeLight(scene, {9, 8, 6});
      break;
    case RoomLight::shell:
      addShape(scene, Sphere{.center = {0.1, 0, 0.2}, .radius = 4, .flipNormals = true}, black);
      makeLight(scene, {1, 0.9, 0.8});
      break;
    case RoomLight::point:
      addEmitter(scene, PointEmitter{{0.1, 0.5, 0.2}, {1, 0.8, 0.6}});
      break;
    case RoomLight::spot:
      addEmitter(scene, SpotEmitter{.position = {0.2, 0.8, 0.3},
                                    .direction = {-0.2 / 1.1, -1.06 / 1.1, -0.21540659 / 1.1},
                                    .intensity = {3, 3, 2},
                                    .cutoffAngle = 50,
                                    .beamWidth = 30});
      break;
    case RoomLight::slide:
      addEmitter(scene, SpotEmitter{.position = {0.6, 0.3, 0.8},
                                    .direction = normalized({-0.6, -0.2031, -0.7738}),
                                    .intensity = {4, 4, 3},
                                    .cutoffAngle = 40,
                                    .beamWidth = 30,
                                    .texture = addPicture(scene),
                                    .toWorld = kFromTheCorner});
      break;
    case RoomLight::projector:
      addEmitter(scene, ProjectorEmitter{.irradiance = {.texture = addPicture(scene)},
                                         .scale = 2,
                                         .fovX = 70,
                                         .aspect = 4.0 / 3,
                                         .toWorld = kFromTheCorner});
      break;
    case RoomLight::directional:
      addEmitter(scene, DirectionalEmitter{{-0.36, -0.48, -0.8}, {3, 2, 2}});
      break;
    case RoomLight::constant:
      addEmitter(scene, ConstantEmitter{{1, 0.9, 0.8}});
      break;
    case RoomLight::envmap: {
      auto bitmap = std::make_shared<Bitmap>();
      bitmap->width = 16;
      bitmap->height = 8;
      for (uint32_t i = 0; i < 16 * 8; ++i) {
        const float glow = i % 16 >= 6 && i % 16 <= 9 && i / 16 >= 2 && i / 16 <= 4 ? 4.0f : 0.3f;
        for (const float tint : {1.0f, 0.9f, 0.7f}) bitmap->pixels.push_back(glow * tint);
      }
      EnvmapEmitter envmap{.bitmap = bitmap, .toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
      addEmitter(scene, envmap);
      break;
    }
  }
}

inline Scene roomScene(const Room& room) {
  Scene scene;
  scene.name = "room";
  const bool mixed = room.materials != RoomMaterials::diffuse, rough = room.materials == RoomMaterials::rough;
  const TexturedFloat alpha{rough ? 0.3 : 0.0};
  const uint32_t white = addDiffuse(scene, 0.7, 0.7, 0.7), red = addDiffuse(scene, 0.7, 0.2, 0.2);
  const uint32_t glossy = addMaterial(scene, Conductor{.eta = {0.2, 0.9, 1.1}, .k = {3.9, 2.4, 2.2}, .alpha = {0.3}});
  const uint32_t phong = addMaterial(scene, Phong{.exponent = 8});

  Mesh floor;
  floor.positions = {{-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (room.tiltedNormals) {
    for (const auto& [x, z] : {std::pair{0.3, 0.1}, {-0.2, 0.3}, {0.1, -0.4}, {-0.3, -0.1}}) {
      const double length = std::sqrt(1 + x * x + z * z);
      floor.normals.push_back(
          {static_cast<float>(x / length), static_cast<float>(1 / length), static_cast<float>(z / length)});
    }
  }
  addShape(scene, floor, white);
  addShape(scene, Rectangle{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, mixed ? phong : white);  // back, facing +z
  addShape(scene, Rectangle{{-1, -1, 1}, {0, 0, -2}, {0, 2, 0}}, red);                    // left, facing +x
  addShape(scene, Rectangle{{1, -1, -1}, {0, 0, 2}, {0, 2, 0}}, mixed ? glossy : white);  // right, facing -x
  addShape(scene, Rectangle{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, white);                   // ceiling, facing -y
  const uint32_t mirror =
      addMaterial(scene, Conductor{.perfectMirror = true, .specularReflectance = {{0.9, 0.9, 0.9}}, .alpha = alpha});
  const uint32_t glass = addMaterial(scene, Dielectric{.intIor = 1.5, .extIor = 1, .alpha = alpha});
  const uint32_t plastic =
      addMaterial(scene, Plastic{.intIor = 1.5, .extIor = 1, .diffuseReflectance = {{0.3, 0.4, 0.7}}, .alpha = alpha});
  addShape(scene, Sphere{.center = {-0.5, -0.65, -0.4}, .radius = 0.35}, mixed ? mirror : red);
  if (mixed) {
    addShape(scene, Sphere{.center = {0.3, -0.7, 0.2}, .radius = 0.3}, glass);
    addShape(scene, Sphere{.center = {0.6, -0.7, -0.5}, .radius = 0.3}, plastic);
  }
  addRoomLight(scene, room.light);
  setCamera(scene, {0.1, 0.05, 3.2}, 45, room.width, room.height);
  return scene;
}

// A floor under an even sky of radiance (1, 1, -0.5), a colour outside of Rec. 709. It reflects all blue and nothing
// else. The camera above sees the floor's middle alone. With walls it is a box that is open above, of the same
// material.
inline Scene wideGamutScene(bool walls, uint32_t width, uint32_t height) {
  Scene scene;
  scene.name = "wide gamut";
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
  addEmitter(scene,
             EnvmapEmitter{.bitmap = bitmap, .toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  setCamera(scene, {0, 0, 3}, 25, width, height);
  return scene;
}

}  // namespace wavecrest
