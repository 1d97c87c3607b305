// Scenes of the engine's tests: the analytic ones of scenes/validation, and a few put together in code.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "engine/load/load.h"
#include "engine/scene/scene.h"
#include "scenes/scene_list.h"

namespace wavecrest {

// A file of scenes/, by its path there without the extension.
inline Scene sceneFile(const std::string& name, uint32_t width, uint32_t height,
                       std::map<std::string, std::string> defines = {}) {
  LoadOptions options;
  options.defines = std::move(defines);
  options.filmSize = {width, height};
  return loadScene(sceneFolder() / (name + ".xml"), options);
}

inline uint32_t addDiffuse(Scene& scene, double r, double g, double b) {
  Material material;
  material.kind = Diffuse{{{r, g, b}}};
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

template <class Kind>
Shape& addShape(Scene& scene, const Kind& kind, uint32_t material) {
  Shape shape;
  shape.kind = kind;
  shape.material = material;
  scene.shapes.push_back(shape);
  return scene.shapes.back();
}

// Makes the last shape a light.
inline void makeLight(Scene& scene, const Rgb& radiance) {
  scene.shapes.back().emitter = static_cast<uint32_t>(scene.emitters.size());
  Emitter emitter;
  emitter.kind = AreaEmitter{{radiance}, static_cast<uint32_t>(scene.shapes.size() - 1)};
  scene.emitters.push_back(emitter);
}

// Looks along -z from `eye`, +y up. The camera's own x axis points to the left of the image.
inline void setCamera(Scene& scene, const Double3& eye, double fovX, uint32_t width, uint32_t height) {
  scene.sensor.toWorld = {{{-1, 0, 0, eye[0]}, {0, 1, 0, eye[1]}, {0, 0, -1, eye[2]}, {0, 0, 0, 1}}};
  scene.sensor.fovX = fovX;
  scene.film.width = width;
  scene.film.height = height;
}

// The Cornell box of scenes/, closed by a front wall that shares its corners; the camera is moved inside.
inline Scene closedCornellBox(uint32_t width, uint32_t height) {
  Scene scene = sceneFile("cornell-diffuse", width, height);
  Mesh front;
  front.positions = {{552.8f, 0, 0}, {0, 0, 0}, {0, 548.8f, 0}, {556, 548.8f, 0}};
  front.triangles = {{1, 0, 3}, {1, 3, 2}};  // facing +z
  addShape(scene, front, addDiffuse(scene, 0.7, 0.7, 0.7));
  setCamera(scene, {278, 273, 10}, 80, width, height);
  scene.sensor.toWorld[0][0] = 1;  // turned to look along +z
  scene.sensor.toWorld[2][2] = 1;
  return scene;
}

}  // namespace wavecrest
