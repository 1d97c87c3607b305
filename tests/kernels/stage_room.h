// The room of the stages' tests, and the kernels that they run on: every precision and specialisation of each
// instruction set.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/columns/wave.h"
#include "tests/kernels/stage_scene.h"

namespace wavecrest {

inline bool covers(Specialization specialization, uint32_t feature) {
  return (kSpecializationFeatures[static_cast<size_t>(specialization)] & feature) != 0;
}

enum RoomMaterial : uint32_t { kWhite, kTwoSidedRed, kMetal, kGlass, kRoughMetal };

inline std::vector<MaterialRecord> roomMaterials() {
  std::vector<MaterialRecord> list(5);
  for (MaterialRecord& m : list) {
    std::fill_n(m.reflectance, 3, 0.8f);
    std::fill_n(m.specular, 3, 0.9f);
    std::fill_n(m.transmittance, 3, 0.95f);
    std::fill_n(m.eta, 3, 0.3f);
    std::fill_n(m.k, 3, 3.5f);
    m.opacity = 1;
    m.flags = kHasFinite;
  }
  list[kTwoSidedRed].reflectance[1] = list[kTwoSidedRed].reflectance[2] = 0.1f;
  list[kTwoSidedRed].flags |= kTwoSided;
  list[kMetal].kind = static_cast<uint32_t>(BsdfKind::conductor);
  list[kMetal].flags = kHasDelta;
  list[kGlass].kind = static_cast<uint32_t>(BsdfKind::dielectric);
  list[kGlass].flags = kHasDelta;
  list[kGlass].eta[0] = 1.5f;
  list[kRoughMetal].kind = static_cast<uint32_t>(BsdfKind::roughConductor);
  list[kRoughMetal].alpha = 0.3f;
  return list;
}

template <class S>
LightRecord<S> areaLight(const PrimitiveRecord<S>& r, LightKind kind, double area) {
  LightRecord<S> light{};
  std::copy_n(r.p0, 3, light.p0);
  std::copy_n(r.e1, 3, light.e1);
  std::copy_n(r.e2, 3, light.e2);
  std::copy_n(r.normal, 3, light.normal);
  light.radiance[0] = S(3);
  light.radiance[1] = S(2);
  light.radiance[2] = S(1);
  light.inverseArea = static_cast<S>(1 / area);
  light.radius = r.e1[0];
  light.offset = S(1e-6);
  light.kind = static_cast<uint32_t>(kind);
  return light;
}

// A map of normals that lean up to 60 degrees, over red and rough metal: those flip, and red is two-sided around its
// map.
template <class S>
void mapNormals(StageScene<S>& scene) {
  constexpr uint32_t kSize = 8;
  static const std::vector<float> texels = [] {
    std::vector<float> list;
    for (uint32_t i = 0; i < kSize * kSize; ++i) {
      const double x = 1.2 * std::sin(2.1 * i), y = 1.2 * std::cos(0.7 * i);
      const double scale = 0.5 / std::sqrt(x * x + y * y + 1);
      for (const double component : {x, y, 1.0}) list.push_back(static_cast<float>(0.5 + scale * component));
    }
    return list;
  }();
  static const TextureRecord texture{.kind = static_cast<uint32_t>(TextureKind::bitmap),
                                     .width = kSize,
                                     .height = kSize,
                                     .offset = 0,
                                     .wrap = static_cast<uint32_t>(WrapMode::repeat),
                                     .nearest = 1,
                                     .toUv = {3, 0, 0, 0, 3, 0},
                                     .color0 = {},
                                     .color1 = {}};
  for (MaterialRecord& m : scene.materials) {
    for (uint32_t* slot : {&m.reflectanceTexture, &m.specularTexture, &m.transmittanceTexture, &m.alphaTexture,
                           &m.opacityTexture, &m.normalTexture, &m.bumpTexture}) {
      *slot = kNoIndex;
    }
  }
  scene.materials[kTwoSidedRed].flags = kHasFinite | kMapped | kFlipsNormals | kSoftensTerminator | kMirrorsBack;
  scene.materials[kRoughMetal].flags = kHasFinite | kMapped | kFlipsNormals;
  for (const RoomMaterial mapped : {kTwoSidedRed, kRoughMetal}) scene.materials[mapped].normalTexture = 0;
  scene.view.textures = &texture;
  scene.view.texels = texels.data();
  scene.view.normalMaps = true;
}

// A turned room of quads, open towards the camera; two triangles in it, and two spheres where the feature set has them.
// Lights: a quad, a triangle, a sphere, a point and the environment. Diffuse unless `specular`.
template <class S>
StageScene<S> makeRoom(bool spheres, bool specular, bool maps) {
  const auto p = [](double x, double y, double z) { return turned({x, y, z}); };
  std::vector<PrimitiveRecord<double>> list{
      quadPrimitive(p(-1, -1, 1), p(1, -1, 1), p(-1, -1, -1)),                     // floor
      quadPrimitive(p(-1, 1, -1), p(1, 1, -1), p(-1, 1, 1)),                       // ceiling
      quadPrimitive(p(-1, -1, -1), p(1, -1, -1), p(-1, 1, -1)),                    // back
      quadPrimitive(p(-1, -1, 1), p(-1, -1, -1), p(-1, 1, 1)),                     // left
      quadPrimitive(p(1, -1, -1), p(1, -1, 1), p(1, 1, -1)),                       // right
      quadPrimitive(p(-0.4, 0.98, -0.4), p(0.4, 0.98, -0.4), p(-0.4, 0.98, 0.4)),  // lamp
      trianglePrimitive(p(-0.8, -0.9, 0.2), p(0.1, -0.7, 0.3), p(-0.5, 0.1, 0.1)),
      trianglePrimitive(p(0.3, -0.2, 0.5), p(0.7, -0.3, 0.6), p(0.5, 0.3, 0.4)),  // glowing
  };
  list[5].light = 0;
  list[7].light = 1;
  if (spheres) {
    list.push_back(spherePrimitive(p(0.4, -0.6, -0.3), 0.35));
    list.push_back(spherePrimitive(p(-0.5, 0.3, -0.4), 0.15));
    list[9].light = 4;
    for (const size_t i : {8u, 9u}) {  // texture coordinates about z, from x
      list[i].e1[2] = list[i].e2[2] = list[i].normal[0] = 1;
    }
  }
  for (uint32_t i = 0; i < list.size(); ++i) list[i].material = i % 2;
  if (specular) {
    list[2].material = kRoughMetal;
    list[4].material = kMetal;
    list[8].material = kGlass;
    list[9].material = kRoughMetal;
  }
  StageScene<S> scene(std::move(list));
  scene.materials = roomMaterials();
  scene.view.materials = scene.materials.data();
  if (maps) mapNormals(scene);

  LightRecord<S> point{}, sky{};
  const Point at = p(0.2, 0.5, 0.8);
  for (size_t i = 0; i < 3; ++i) {
    point.p0[i] = static_cast<S>(at[i]);
    point.radiance[i] = S(0.5);
    sky.radiance[i] = S(0.25);
  }
  point.kind = static_cast<uint32_t>(LightKind::point);
  sky.kind = static_cast<uint32_t>(LightKind::constant);
  std::vector<LightRecord<S>> lights{areaLight(scene.records[5], LightKind::quad, 0.64),
                                     areaLight(scene.records[7], LightKind::triangle, 0.11), point, sky};
  if (spheres) lights.push_back(areaLight(scene.records[9], LightKind::sphere, 4 * 3.14159265 * 0.15 * 0.15));
  scene.setLights(std::move(lights));

  scene.setCamera(pinholeCamera(p(0.1, 0.05, 3.2), p(-0.5, 0.5, -1.5), p(1.0 / 24, 0, 0), p(0, -1.0 / 24, 0), 24));
  return scene;
}

// What the session gives to waves of these kernels (engine/plan/render_plan.cpp).
inline ColumnNeeds columnNeedsOf(Specialization specialization) {
  const uint32_t features = kSpecializationFeatures[static_cast<size_t>(specialization)];
  return {.shadingNormals = (features & kShadingNormals) != 0,
          .textures = (features & kTextures) != 0,
          .normalMaps = (features & kNormalMaps) != 0,
          .tangents = (features & kCompoundBsdfs) != 0,
          .rouletteScale = (features & (kSpecularBsdfs | kBidirectional)) != 0,
          .connections = (features & kBidirectional) != 0,
          .bsdfOrder = (features & (kSpecularBsdfs | kLayeredBsdfs)) != 0};
}

struct Choice {
  Isa isa;
  Precision precision;
  Specialization specialization;
};

inline std::vector<Choice> allChoices() {
  std::vector<Choice> choices;
  for (const Isa isa : availableIsas()) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      for (size_t i = 0; i < kSpecializationCount; ++i) {
        const auto specialization = static_cast<Specialization>(i);
        if (isCompiled(precision, specialization)) choices.push_back({isa, precision, specialization});
      }
    }
  }
  return choices;
}
inline std::string nameOf(const Choice& choice) {
  std::string name = std::string(toString(choice.isa)) + "_" +
                     std::string(kPrecisionNames[static_cast<size_t>(choice.precision)]) + "_" +
                     std::string(kSpecializationNames[static_cast<size_t>(choice.specialization)]);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace wavecrest
