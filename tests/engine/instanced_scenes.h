// Scenes with groups and instances of every kind of transform, and rays through them.
#pragma once

#include <random>

#include "tests/engine/light_scenes.h"

namespace wavecrest {

// Puts the point `center` of a group `at` a point of the world.
inline Matrix4 placedAt(const Double3& at, const Double3 (&columns)[3], const Double3& center = {}) {
  Matrix4 m{};
  const Double3 offset = at - (columns[0] * center[0] + columns[1] * center[1] + columns[2] * center[2]);
  for (size_t i = 0; i < 3; ++i) m[i] = {columns[0][i], columns[1][i], columns[2][i], offset[i]};
  m[3] = {0, 0, 0, 1};
  return m;
}

inline void addInstance(Scene& scene, uint32_t group, const Matrix4& toWorld) {
  scene.instances.push_back({.id = {}, .group = group, .toWorld = toWorld, .source = {}});
}

// A closed mesh around `center` of `rings` times 2 `rings` faces, with vertex normals and texture coordinates.
inline Mesh ballMesh(const Double3& center, double radius, uint32_t rings) {
  Mesh mesh;
  const uint32_t across = 2 * rings;
  for (uint32_t i = 0; i <= rings; ++i) {
    for (uint32_t j = 0; j <= across; ++j) {
      const double theta = 3.14159265358979 * i / rings, phi = 2 * 3.14159265358979 * (j % across) / across;
      const double sine = i == 0 || i == rings ? 0 : std::sin(theta);
      const Double3 n{sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)}, p = center + n * radius;
      mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      mesh.normals.push_back({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
      mesh.uvs.push_back(
          {static_cast<float>(j) / static_cast<float>(across), static_cast<float>(i) / static_cast<float>(rings)});
    }
  }
  for (uint32_t i = 0; i < rings; ++i) {
    for (uint32_t j = 0; j < across; ++j) {
      const uint32_t a = i * (across + 1) + j, b = a + across + 1;
      if (i > 0) mesh.triangles.push_back({a, b, a + 1});
      if (i + 1 < rings) mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }
  return mesh;
}

// Where groups lie in their own space.
constexpr Double3 kGroupCenter{5, 4, 3};

// Turned, mirrored, stretched, sheared and flattened.
inline std::vector<Matrix4> allKindsOfPlaces() {
  return {placedAt({0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kGroupCenter),
          placedAt({3, 1, -2}, {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}, kGroupCenter),
          placedAt({-4, 0.5, 2}, {{-1.5, 0, 0}, {0, 1.5, 0}, {0, 0, 1.5}}, kGroupCenter),
          placedAt({0, -4, 1}, {{0.3, 0, 0}, {0, 2, 0}, {0, 0, 1}}, kGroupCenter),
          placedAt({1, 4, 4}, {{1, 0.2, 0}, {0.5, 1, 0.3}, {0, 0.4, -0.7}}, kGroupCenter),
          placedAt({-3, -3, -4}, {{0.8, 0.6, 0}, {-0.06, 0.08, 0}, {0, 0, 1.2}}, kGroupCenter)};
}

// A mesh and what other shapes there are, in a group that lies off its origin, once for each of these places, above a
// floor. spheres: an analytic sphere as well, which not every place leaves one.
inline Scene placedScene(const std::vector<Matrix4>& places, bool spheres, uint32_t rings = 12) {
  Scene scene;
  scene.groups.push_back({.id = "things", .source = {}});
  scene.textures.push_back(
      {.kind = CheckerboardTexture{}, .toUv = {{{8, 0, 0, 0}, {0, 8, 0, 0}, {0, 0, 8, 0}, {0, 0, 0, 1}}}});
  const uint32_t textured = addMaterial(scene, Diffuse{{{0.5, 0.5, 0.5}, 0}}, true);
  Conductor brushed;
  brushed.alpha.value = 0.3;
  brushed.alphaV = TexturedFloat{0.1};
  const uint32_t metal = addMaterial(scene, brushed, true);
  const auto inGroup = [&](Shape& shape) { shape.group = 0; };
  inGroup(addShape(scene, ballMesh({5, 4, 3}, 0.8, rings), textured));
  inGroup(addShape(scene, Rectangle{{4, 3, 2.1}, {2, 0, 0.1}, {0, 1.9, 0}}, metal));
  inGroup(addShape(scene, Disk{.center = {5, 4, 4.1}, .axisU = {0.5, 0, 0}, .axisV = {0, 0.5, 0}}, metal));
  inGroup(addShape(
      scene, Cylinder{.p0 = {4.2, 3.5, 4}, .p1 = {4.2, 4.5, 4}, .radius = 0.2, .phi0 = {0, 0, 1}, .phi90 = {1, 0, 0}},
      metal));
  Mesh flat = ballMesh({5.9, 4, 3.9}, 0.3, 6);
  flat.normals.clear();
  flat.uvs.clear();
  inGroup(addShape(scene, flat, metal));
  if (spheres) {
    Sphere sphere{.center = {6, 4.6, 2.4}, .radius = 0.4};
    sphere.toWorld = {{{0.4, 0, 0, 6}, {0, 0.4, 0, 4.6}, {0, 0, 0.4, 2.4}, {0, 0, 0, 1}}};
    inGroup(addShape(scene, sphere, textured));
  }
  addShape(scene, Rectangle{{-9, -9, -6}, {18, 0, 0}, {0, 18, 0}}, textured);
  for (const Matrix4& place : places) addInstance(scene, 0, place);
  setCamera(scene, {0, 0, 20}, 60, 32, 24);
  return scene;
}

// Origins in and around the scene and directions to all sides; many towards points within it.
struct RandomRay {
  Double3 origin, direction;
};
inline std::vector<RandomRay> randomRays(size_t count, double reach, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Double3{uniform(random), uniform(random), uniform(random)} * reach; };
  std::vector<RandomRay> rays;
  while (rays.size() < count) {
    const Double3 from = point(), to = point();
    if (length(to - from) < 1e-3 * reach) continue;
    RandomRay ray{from, normalized(to - from)};
    for (double& c : ray.origin) c = static_cast<float>(c);
    for (double& c : ray.direction) c = static_cast<float>(c);
    rays.push_back(ray);
  }
  return rays;
}

// A sphere of radius 1e-8 in a group, and an instance of it.
inline Scene tinySphere(double scale) {
  Scene scene;
  scene.groups.push_back({.id = "tiny", .source = {}});
  Sphere sphere{.center = {0, 0, 0}, .radius = 1e-8};
  sphere.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  addShape(scene, sphere, addDiffuse(scene, 0.5, 0.5, 0.5)).group = 0;
  addInstance(scene, 0, placedAt({0, 0, 0}, {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}));
  setCamera(scene, {0, 0, 3e-8 * scale}, 60, 8, 8);
  return scene;
}

}  // namespace wavecrest
