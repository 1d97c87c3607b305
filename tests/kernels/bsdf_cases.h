// The materials that BSDF tests run over, and directions and draws for them.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "engine/compile/materials.h"
#include "tests/kernels/bsdf_entries.h"

namespace wavecrest {

struct BsdfCase {
  std::string name;
  MaterialRecord record;
  bool back = false;  // light may also come from below
};

inline BsdfCase bsdfCase(std::string name, decltype(Material::kind) kind, bool back = false,
                         std::optional<double> opacity = {}) {
  Material material;
  material.kind = kind;
  if (opacity) material.opacity = TexturedFloat{*opacity};
  return {std::move(name), compileMaterial(material, Scene{}), back};
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
    return all;
  }();
  return cases;
}

inline Direction fromAngles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
inline double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Directions back along the path for a case: near normal, oblique and grazing; from below too where light may come.
inline std::vector<Direction> fixDirections(const BsdfCase& bsdf) {
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
void forEachDraw(const BsdfEntries& entries, const BsdfQuery& query, const Direction& fix, size_t count, uint32_t seed,
                 Function&& function) {
  constexpr size_t kBatch = 4096;
  const std::vector<Direction> fixes(std::min(count, kBatch), fix);
  std::vector<BsdfDraw> draws(fixes.size());
  for (size_t first = 0; first < count; first += kBatch) {
    const size_t size = std::min(kBatch, count - first);
    const auto u = randomDraws(size, seed + static_cast<uint32_t>(first));
    entries.sample(query, std::span(fixes).first(size), u, draws.data());
    for (size_t i = 0; i < size; ++i) function(draws[i]);
  }
}

inline std::vector<BsdfDraw> drawSamples(const BsdfEntries& entries, const BsdfQuery& query, const Direction& fix,
                                         size_t count, uint32_t seed) {
  std::vector<BsdfDraw> draws;
  forEachDraw(entries, query, fix, count, seed, [&](const BsdfDraw& draw) { draws.push_back(draw); });
  return draws;
}

inline std::vector<BsdfEvaluation> evaluate(const BsdfEntries& entries, const BsdfQuery& query,
                                            std::span<const Direction> fix, std::span<const Direction> gen) {
  std::vector<BsdfEvaluation> values(fix.size());
  entries.eval(query, fix, gen, values.data());
  return values;
}

}  // namespace wavecrest
