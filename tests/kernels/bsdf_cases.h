// The materials that BSDF tests run over, and directions and draws for them.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/compile/materials.h"
#include "tests/kernels/bsdf_entries.h"

namespace wavecrest {

// The records of a material and of its parts, which follow it.
struct BsdfTables {
  std::vector<MaterialRecord> materials;
  std::vector<CompoundRecord> compounds;
};

struct BsdfCase {
  std::string name;
  std::shared_ptr<BsdfTables> tables;
  bool back = false;  // light may also come from below
  const MaterialRecord& record = tables->materials.front();
  // Null where the BSDF is no compound one.
  const CompoundRecord* compounds =
      (bitOf(static_cast<BsdfKind>(record.kind)) & kCompoundKinds) != 0 ? tables->compounds.data() : nullptr;

  bool isAmong(uint32_t kinds) const { return (bitOf(static_cast<BsdfKind>(record.kind)) & kinds) != 0; }
};

inline BsdfCase bsdfCase(std::string name, decltype(Material::kind) kind, bool back = false,
                         std::optional<double> opacity = {}, const std::vector<Material>& parts = {}) {
  Scene scene;
  Material& material = scene.materials.emplace_back();
  material.kind = std::move(kind);
  if (opacity) material.opacity = TexturedFloat{*opacity};
  scene.materials.insert(scene.materials.end(), parts.begin(), parts.end());
  auto tables = std::make_shared<BsdfTables>();
  for (const Material& each : scene.materials) {
    tables->materials.push_back(compileMaterial(each, scene));
    tables->compounds.push_back(compileCompound(each));
  }
  return {std::move(name), std::move(tables), back};
}

inline Material partOf(decltype(Material::kind) kind, std::optional<double> opacity = {}, bool twoSided = false) {
  Material part;
  part.kind = std::move(kind);
  part.twoSided = twoSided;
  if (opacity) part.opacity = TexturedFloat{*opacity};
  return part;
}
// A blend of these parts.
inline BsdfCase blendCase(std::string name, std::vector<double> weights, const std::vector<Material>& parts, bool back,
                          std::optional<double> opacity = {}) {
  Blend blend{.materials = {}, .weights = std::move(weights)};
  for (uint32_t i = 1; i <= parts.size(); ++i) blend.materials.push_back(i);
  return bsdfCase(std::move(name), blend, back, opacity, parts);
}

inline TexturedRgb rgb(double r, double g, double b) { return {{r, g, b}}; }

// Aluminium, roughly, in red, green and blue.
inline Conductor aluminium(double alpha, Distribution distribution = Distribution::ggx) {
  return {.eta = {1.66, 0.88, 0.52}, .k = {9.22, 6.27, 4.84}, .alpha = {alpha}, .distribution = distribution};
}
inline Dielectric glass(double alpha, double eta, Distribution distribution = Distribution::ggx) {
  return {.intIor = eta, .extIor = 1, .alpha = {alpha}, .distribution = distribution};
}
inline Plastic plastic(double alpha, double eta = 1.5, Distribution distribution = Distribution::ggx) {
  return {.intIor = eta,
          .extIor = 1,
          .diffuseReflectance = rgb(0.7, 0.4, 0.2),
          .alpha = {alpha},
          .distribution = distribution};
}
inline Phong phong(double exponent) {
  return {.diffuseReflectance = rgb(0.5, 0.3, 0.1), .specularReflectance = rgb(0.2, 0.4, 0.3), .exponent = exponent};
}

inline Principled principledCoat() {
  return {.baseColor = rgb(0.8, 0.5, 0.2),
          .roughness = {0.4},
          .anisotropic = {0.6},
          .specTint = {0.5},
          .sheen = {0.1},
          .sheenTint = {0.5},
          .flatness = {0.4},
          .metallic = {0.3},
          .clearcoat = {0.8},
          .clearcoatGloss = {0.2}};
}
inline Principled principledGlass() {
  return {.baseColor = rgb(0.9, 0.6, 0.3),
          .eta = 1.4,
          .roughness = {0.5},
          .anisotropic = {0.3},
          .specTrans = {0.7},
          .specTint = {0.2},
          .metallic = {0.2}};
}
inline Principled principledSheet() {
  return {.thin = true,
          .baseColor = rgb(0.7, 0.5, 0.3),
          .eta = 1.5,
          .roughness = {0.6},
          .anisotropic = {0.4},
          .specTrans = {0.5},
          .specTint = {0.3},
          .sheen = {0.2},
          .flatness = {0.5},
          .diffTrans = {0.8}};
}

// Compound kinds: two roughnesses, principled ones, and blends of all sorts of lobes.
inline void appendCompound(std::vector<BsdfCase>& all) {
  for (const Distribution distribution : {Distribution::ggx, Distribution::beckmann}) {
    const std::string suffix = distribution == Distribution::ggx ? "" : "Beckmann";
    Conductor metal = aluminium(0.1, distribution);
    metal.alphaV = TexturedFloat{0.4};
    Dielectric ice = glass(0.5, 1.5, distribution);
    ice.alphaV = TexturedFloat{0.2};
    all.push_back(bsdfCase("anisotropicConductor" + suffix, metal));
    all.push_back(bsdfCase("anisotropicDielectric" + suffix, ice, true));
  }
  all.push_back(bsdfCase("principledCoat", principledCoat()));
  all.push_back(bsdfCase("principledGlass", principledGlass(), true));
  all.push_back(bsdfCase("principledOpacity", principledCoat(), false, 0.4));
  all.push_back(bsdfCase("principledThin", principledSheet(), true));
  const Material paint = partOf(Diffuse{rgb(0.8, 0.5, 0.2)}), black = partOf(Diffuse{rgb(0, 0, 0)});
  all.push_back(blendCase("blendMetal", {0.3, 0.7}, {paint, partOf(aluminium(0.3))}, false));
  all.push_back(blendCase("blendBlack", {0.5, 0.5}, {black, partOf(aluminium(0.2))}, false));
  all.push_back(
      blendCase("blendMirror", {0.6, 0.4}, {partOf(plastic(0)), partOf(Conductor{.perfectMirror = true})}, false));
  all.push_back(
      blendCase("blendDeltas", {0.6, 0.4}, {partOf(aluminium(0)), partOf(Conductor{.perfectMirror = true})}, false));
  all.push_back(
      blendCase("blendGlass", {0.5, 0.3, 0.2}, {partOf(glass(0.3, 1.5)), paint, partOf(glass(0, 1.5))}, true));
  all.push_back(
      blendCase("blendHoles", {0.4, 0.4}, {partOf(plastic(0.2), 0.5), partOf(principledCoat(), 0.7)}, false, 0.8));
  all.push_back(blendCase("blendTwoSided", {0.5, 0.5}, {partOf(Diffuse{rgb(0.6, 0.6, 0.6)}, {}, true), paint}, true));
}

// Every kind, with parameters from the middle of their ranges; extremes have a test of their own.
inline const std::vector<BsdfCase>& bsdfCases() {
  static const std::vector<BsdfCase> cases = [] {
    std::vector<BsdfCase> all{
        bsdfCase("diffuse", Diffuse{rgb(0.8, 0.5, 0.2)}),
        bsdfCase("conductor", aluminium(0)),
        bsdfCase("mirror", Conductor{.perfectMirror = true}),
        bsdfCase("dielectric", glass(0, 1.5), true),
        bsdfCase("thinDielectric", Dielectric{.intIor = 1.5, .extIor = 1, .thin = true}, true),
        bsdfCase("plastic", plastic(0)),
        bsdfCase("phong1", phong(1)),
        bsdfCase("phong30", phong(30)),
        bsdfCase("phong1000", phong(1000)),
        bsdfCase("opacity", Diffuse{rgb(0.8, 0.5, 0.2)}, false, 0.3),
        bsdfCase("glassOpacity", glass(0.3, 1.5), true, 0.6),
    };
    for (const double alpha : {0.03, 0.2, 0.7, 1.0}) {
      all.push_back(bsdfCase("roughConductor" + std::to_string(alpha), aluminium(alpha)));
    }
    for (const double alpha : {0.05, 0.3, 0.6}) {
      all.push_back(bsdfCase("roughDielectric" + std::to_string(alpha), glass(alpha, 1.5), true));
    }
    all.push_back(bsdfCase("roughDiamond", glass(0.2, 2.4), true));
    all.push_back(bsdfCase("roughBubble", glass(0.2, 1 / 1.33), true));
    for (const double alpha : {0.05, 0.3}) {
      all.push_back(bsdfCase("roughPlastic" + std::to_string(alpha), plastic(alpha)));
    }
    for (const double alpha : {0.1, 0.5}) {
      const std::string suffix = std::to_string(alpha);
      all.push_back(bsdfCase("beckmannConductor" + suffix, aluminium(alpha, Distribution::beckmann)));
      all.push_back(bsdfCase("beckmannDielectric" + suffix, glass(alpha, 1.5, Distribution::beckmann), true));
      all.push_back(bsdfCase("beckmannPlastic" + suffix, plastic(alpha, 1.5, Distribution::beckmann)));
    }
    Plastic saturated = plastic(0.2, 1.9);
    saturated.nonlinear = true;
    saturated.specularReflectance = rgb(0.9, 0.7, 0.5);
    all.push_back(bsdfCase("roughPlasticNonlinear", saturated));
    saturated.alpha = {0};
    all.push_back(bsdfCase("plasticNonlinear", saturated));
    appendCompound(all);
    return all;
  }();
  return cases;
}

inline Direction fromAngles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
inline double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Directions back along the path for a case: near normal, oblique and grazing; from below too where light may come.
inline std::vector<Direction> wiDirections(const BsdfCase& bsdf) {
  std::vector<Direction> directions{fromAngles(0.05, 1.0), fromAngles(0.9, 4.0), fromAngles(1.5, 2.0)};
  if (bsdf.back) {
    directions.push_back(fromAngles(std::numbers::pi - 0.4, 0.5));
    directions.push_back(fromAngles(std::numbers::pi - 1.2, 5.5));
  }
  return directions;
}

// Uniform on the sphere.
inline std::vector<Direction> randomDirections(size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Direction> directions(count);
  for (Direction& d : directions) {
    const double z = 2 * uniform(generator) - 1;
    d = fromAngles(std::acos(z), 2 * std::numbers::pi * uniform(generator));
  }
  return directions;
}

// Draws on the sampler's grid of 2^-24.
inline std::vector<std::array<float, 3>> randomDraws(size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<std::array<float, 3>> draws(count);
  for (auto& draw : draws) {
    for (float& number : draw) number = static_cast<float>(generator() >> 8) * 0x1p-24f;
  }
  return draws;
}

// Calls function(draw) for each of `count` draws, in batches that stay in cache.
template <class Function>
void forEachDraw(const BsdfEntries& entries, const BsdfQuery& query, const Direction& wi, size_t count, uint32_t seed,
                 Function&& function) {
  constexpr size_t kBatch = 4096;
  const std::vector<Direction> fixes(std::min(count, kBatch), wi);
  std::vector<BsdfDraw> draws(fixes.size());
  for (size_t first = 0; first < count; first += kBatch) {
    const size_t size = std::min(kBatch, count - first);
    const auto u = randomDraws(size, seed + static_cast<uint32_t>(first));
    entries.sample(query, std::span(fixes).first(size), u, draws.data());
    for (size_t i = 0; i < size; ++i) function(draws[i]);
  }
}

inline std::vector<BsdfDraw> drawSamples(const BsdfEntries& entries, const BsdfQuery& query, const Direction& wi,
                                         size_t count, uint32_t seed) {
  std::vector<BsdfDraw> draws;
  forEachDraw(entries, query, wi, count, seed, [&](const BsdfDraw& draw) { draws.push_back(draw); });
  return draws;
}

inline std::vector<BsdfEvaluation> evaluate(const BsdfEntries& entries, const BsdfQuery& query,
                                            std::span<const Direction> wi, std::span<const Direction> wo) {
  std::vector<BsdfEvaluation> values(wi.size());
  entries.eval(query, wi, wo, values.data());
  return values;
}

}  // namespace wavecrest
