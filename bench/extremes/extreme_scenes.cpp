#include "bench/extremes/extreme_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

constexpr Matrix4 kUnit{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

uint32_t addMaterial(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}
// A diffuse material that reflects `albedo` of every colour.
uint32_t addGrey(Scene& scene, double albedo) {
  Material material;
  material.kind = Diffuse{{{albedo, albedo, albedo}}};
  return addMaterial(scene, material);
}
template <class Kind>
void addShape(Scene& scene, const Kind& kind, uint32_t material) {
  Shape shape;
  shape.kind = kind;
  shape.material = material;
  scene.shapes.push_back(shape);
}
// Makes the last shape shine.
void addLight(Scene& scene, double radiance) {
  scene.shapes.back().emitter = static_cast<uint32_t>(scene.emitters.size());
  Emitter emitter;
  emitter.kind = AreaEmitter{{{radiance, radiance, radiance}}, static_cast<uint32_t>(scene.shapes.size() - 1)};
  scene.emitters.push_back(emitter);
}
// The same radiance from all directions.
void addSky(Scene& scene, double radiance) {
  Emitter emitter;
  emitter.kind = ConstantEmitter{{radiance, radiance, radiance}};
  scene.emitters.push_back(emitter);
}

// Looks along -z from `eye`, +y up.
void setCamera(Scene& scene, const Double3& eye, double fov) {
  // A camera looks along its +z and has +x to the left: both axes are turned around.
  scene.sensor.toWorld = {{{-1, 0, 0, eye[0]}, {0, 1, 0, eye[1]}, {0, 0, -1, eye[2]}, {0, 0, 0, 1}}};
  scene.sensor.fovX = fov;
  scene.film.width = scene.film.height = kExtremeSide;
}
// Parallel rays along `direction` that cover two `halfWidth` by two `halfHeight` around the origin.
void setParallelCamera(Scene& scene, const Double3& direction, const Double3& up, double halfWidth, double halfHeight,
                       double distance) {
  setCamera(scene, {}, 40);
  scene.sensor.kind = Sensor::Kind::orthographic;
  const Double3 axis = normalized(direction), left = normalized(cross(up, axis)), above = cross(axis, left);
  const Double3 eye = axis * -distance;
  // An orthographic film reaches from -1 to 1, so the columns of the matrix are its half sides.
  for (size_t i = 0; i < 3; ++i) {
    scene.sensor.toWorld[i] = {left[i] * halfWidth, above[i] * halfHeight, axis[i], eye[i]};
  }
}

// The walls of a room of half side 1, times size and about a centre, facing inwards: floor, ceiling, back, front, left
// and right. The same corners in all that meet there.
std::vector<Rectangle> walls(double size, const Double3& center) {
  const auto wall = [&](const Double3& corner, const Double3& u, const Double3& v) {
    return Rectangle{.corner = center + corner * size, .edgeU = u * size, .edgeV = v * size};
  };
  return {wall({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), wall({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}),
          wall({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), wall({1, -1, 1}, {-2, 0, 0}, {0, 2, 0}),
          wall({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}), wall({1, -1, -1}, {0, 0, 2}, {0, 2, 0})};
}

}  // namespace

Scene lampBox(const BoxOptions& options) {
  Scene scene;
  const uint32_t white = addGrey(scene, 0.6), dark = addGrey(scene, 0.3);
  const double size = options.size;
  // The room, and the sphere on its floor.
  for (const Rectangle& wall : walls(size, options.center)) addShape(scene, wall, white);
  if (options.sphere) {
    addShape(scene,
             Sphere{.center = options.center + Double3{0.3, -0.6, -0.3} * size, .radius = 0.4 * size, .toWorld = kUnit},
             dark);
  }
  // The lamp. Radiance grows as area shrinks, so the power does not change.
  const double half = options.lampSide / 2, ratio = 0.5 / options.lampSide;
  addShape(scene,
           Rectangle{.corner = options.center + Double3{-half, 0.9, -half} * size,
                     .edgeU = Double3{2 * half, 0, 0} * size,
                     .edgeV = Double3{0, 0, 2 * half} * size},
           dark);
  addLight(scene, options.lampRadiance * ratio * ratio);
  setCamera(scene, options.center + Double3{0, 0, 0.95} * size, 70);
  return scene;
}

Scene shiningRoom(double albedo, double fov) {
  Scene scene;
  const uint32_t material = addGrey(scene, albedo);
  // The radiance L is the same everywhere: L = 1 + albedo L.
  for (const Rectangle& wall : walls(1, {})) {
    addShape(scene, wall, material);
    addLight(scene, 1);
  }
  setCamera(scene, {0, 0, 0.5}, fov);
  return scene;
}

Scene besideBrightRoom(double albedo, double ratio) {
  Scene scene = shiningRoom(albedo);
  // The second room is closed as well, so none of its light reaches the first.
  for (const Rectangle& wall : walls(1, {5, 0, 0})) {
    addShape(scene, wall, 0);
    addLight(scene, ratio);
  }
  return scene;
}

Scene closeToWall(double albedo, double distance) {
  Scene scene = shiningRoom(albedo);
  setCamera(scene, {0, 0, -1 + distance}, 70);
  return scene;
}

Scene roomCorner(double albedo, double fov) {
  Scene scene = shiningRoom(albedo, fov);
  // From the centre towards the corner at (1, 1, 1).
  const Double3 axis = normalized({1, 1, 1}), left = normalized(cross({0, 1, 0}, axis)), up = cross(axis, left);
  for (size_t i = 0; i < 3; ++i) scene.sensor.toWorld[i] = {left[i], up[i], axis[i], 0};
  return scene;
}

Scene skySphere(const Material& material) {
  Scene scene;
  addShape(scene, Sphere{.radius = 1, .toWorld = kUnit}, addMaterial(scene, material));
  addSky(scene, 1);
  setCamera(scene, {0, 0, 4}, 25);
  return scene;
}

Scene withinSphere(const Material& material) {
  Scene scene = skySphere(material);
  setCamera(scene, {}, 70);
  return scene;
}

Scene skySquare(const Material& material) {
  Scene scene;
  addShape(scene, Rectangle{.corner = {-1, -1, 0}, .edgeU = {2, 0, 0}, .edgeV = {0, 2, 0}},
           addMaterial(scene, material));
  addSky(scene, 1);
  setParallelCamera(scene, {0, 0, -1}, {0, 1, 0}, 0.5, 0.5, 1);
  return scene;
}

Scene nestedGlass(uint32_t shells) {
  Scene scene;
  for (uint32_t i = 0; i < shells; ++i) {
    Material glass;
    // The index of a sphere is 0.1 above the index of the sphere around it.
    glass.kind = Dielectric{.intIor = 1.2 + 0.1 * i, .extIor = i == 0 ? 1.0 : 1.1 + 0.1 * i};
    addShape(scene, Sphere{.radius = 1 - 0.7 * i / shells, .toWorld = kUnit}, addMaterial(scene, glass));
  }
  addSky(scene, 1);
  setCamera(scene, {0, 0, 4}, 25);
  return scene;
}

Scene litFloor(double lightDistance, double lightRadius) {
  Scene scene;
  addShape(scene, Rectangle{.corner = {-1, -1, 0}, .edgeU = {2, 0, 0}, .edgeV = {0, 2, 0}}, addGrey(scene, 1));
  // An irradiance of I / d^2 at the foot, and radiance of I / (pi r^2) where the light has a size.
  const double intensity = std::numbers::pi * lightDistance * lightDistance;
  if (lightRadius > 0) {
    addShape(scene, Sphere{.center = {0, 0, lightDistance}, .radius = lightRadius, .toWorld = kUnit},
             addGrey(scene, 0));
    addLight(scene, intensity / (std::numbers::pi * lightRadius * lightRadius));
  } else {
    Emitter emitter;
    emitter.kind = PointEmitter{.position = {0, 0, lightDistance}, .intensity = {intensity, intensity, intensity}};
    scene.emitters.push_back(emitter);
  }
  setParallelCamera(scene, {0, 0.6, -0.8}, {0, 1, 0}, 0.1, 0.1, 2);
  return scene;
}

Scene spotFloor(double cutoff) {
  Scene scene;
  addShape(scene, Rectangle{.corner = {-1, -1, 0}, .edgeU = {2, 0, 0}, .edgeV = {0, 2, 0}}, addGrey(scene, 1));
  Emitter emitter;
  constexpr double kPi = std::numbers::pi;
  emitter.kind = SpotEmitter{.position = {0, 0, 1},
                             .direction = {0, 0, -1},
                             .intensity = {kPi, kPi, kPi},
                             .cutoffAngle = cutoff,
                             .beamWidth = 0,
                             .toWorld = kUnit};
  scene.emitters.push_back(emitter);
  const double radius = std::tan(cutoff * kPi / 180);
  setParallelCamera(scene, {0, 0, -1}, {0, 1, 0}, radius, radius, 0.5);
  return scene;
}

Scene polarSky(uint32_t rows) {
  Scene scene;
  addShape(scene, Rectangle{.corner = {-1, 0, 1}, .edgeU = {2, 0, 0}, .edgeV = {0, 0, -2}}, addGrey(scene, 0.5));
  // Radiance falls in a line from L at the pole to 0 at the next row, at an angle d: an irradiance of pi L d^2 / 3.
  const double next = std::numbers::pi / (rows - 1);
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 8;
  bitmap->height = rows;
  bitmap->channels = 3;
  bitmap->pixels.assign(size_t{3} * bitmap->width * rows, 0.0f);
  std::fill_n(bitmap->pixels.begin(), 3 * bitmap->width, static_cast<float>(3 / (next * next)));
  Emitter emitter;
  emitter.kind = EnvmapEmitter{.bitmap = bitmap, .scale = 1, .toWorld = kUnit};
  scene.emitters.push_back(emitter);
  setParallelCamera(scene, {0, -1, 0}, {0, 0, 1}, 0.5, 0.5, 1);
  return scene;
}

Scene grazedFloor(double angle) {
  Scene scene;
  addShape(scene, Rectangle{.corner = {-1, -1, 0}, .edgeU = {2, 0, 0}, .edgeV = {0, 2, 0}}, addGrey(scene, 0.5));
  addSky(scene, 1);
  // The picture's height shrinks with the sine of the angle, so that the picture covers the same part of the floor.
  setParallelCamera(scene, {0, std::cos(angle), -std::sin(angle)}, {0, 0, 1}, 0.5, 0.5 * std::sin(angle), 3);
  return scene;
}

Scene sliverFloor(double aspect) {
  constexpr uint32_t kSlivers = 64;
  Scene scene;
  const uint32_t material = addGrey(scene, 0.5);
  // A strip of narrow triangles of height 1.
  const double width = 1 / aspect;
  Mesh mesh;
  for (uint32_t i = 0; i <= kSlivers; ++i) {
    const auto x = static_cast<float>((i - kSlivers / 2.0) * width);
    mesh.positions.push_back({x, -0.5f, 0});
    mesh.positions.push_back({x, 0.5f, 0});
  }
  for (uint32_t i = 0; i < kSlivers; ++i) {
    const uint32_t at = 2 * i;
    mesh.triangles.push_back({at, at + 2, at + 3});
    mesh.triangles.push_back({at, at + 3, at + 1});
    mesh.triangles.push_back({at, at + 2, at});  // no area
  }
  addShape(scene, mesh, material);
  addShape(scene, mesh, material);  // in the same plane
  addSky(scene, 1);
  // The floor reaches beyond the picture on all sides.
  setParallelCamera(scene, {0, 0, -1}, {0, 1, 0}, 0.4 * kSlivers * width, 0.4, 1);
  return scene;
}

Scene hotSky(double brightness) {
  Scene scene;
  addShape(scene, Sphere{.radius = 1, .toWorld = kUnit}, addGrey(scene, 0.5));
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 16;
  bitmap->height = 8;
  bitmap->channels = 3;
  bitmap->pixels.assign(size_t{3} * 16 * 8, 0.0f);
  // The texel in column 5 and row 3.
  for (size_t c = 0; c < 3; ++c) bitmap->pixels[3 * (3 * 16 + 5) + c] = static_cast<float>(brightness);
  Emitter emitter;
  emitter.kind = EnvmapEmitter{.bitmap = bitmap, .scale = 1, .toWorld = kUnit};
  scene.emitters.push_back(emitter);
  // Narrow: the sphere fills the picture.
  setCamera(scene, {0, 0, 4}, 20);
  return scene;
}

}  // namespace wavecrest
