// Our BSDFs against Mitsuba 3's plugins: golden/bsdf.json holds what its Python bindings returned.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/kernels/bsdf_cases.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

using Json = nlohmann::json;

class BsdfGoldenTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(BsdfGoldenTest);

const Json& golden() {
  static const Json document = Json::parse(std::ifstream(WAVECREST_GOLDEN_DIR "/bsdf.json"));
  return document;
}

Rgb colour(const Json& material, const char* name, const Rgb& otherwise) {
  return material.contains(name) ? material[name].get<Rgb>() : otherwise;
}

Principled principledOf(const Json& m) {
  const Json& numbers = m["numbers"];
  const auto number = [&](const char* name, double otherwise) { return TexturedFloat{numbers.value(name, otherwise)}; };
  return {.thin = m["type"] == "principledthin",
          .baseColor = {m["base"].get<Rgb>()},
          .eta = numbers.value("eta", 1.5),
          .roughness = number("roughness", 0.5),
          .anisotropic = number("anisotropic", 0),
          .specTrans = number("spec_trans", 0),
          .specTint = number("spec_tint", 0),
          .sheen = number("sheen", 0),
          .sheenTint = number("sheen_tint", 0),
          .flatness = number("flatness", 0),
          .metallic = number("metallic", 0),
          .clearcoat = number("clearcoat", 0),
          .clearcoatGloss = number("clearcoat_gloss", 0),
          .diffTrans = number("diff_trans", 0)};
}

decltype(Material::kind) kindOf(const Json& m) {
  const std::string type = m["type"];
  const Distribution distribution =
      m.value("distribution", "") == "beckmann" ? Distribution::beckmann : Distribution::ggx;
  const TexturedFloat alpha{m.value("alpha", 0.0)};
  const TexturedRgb diffuse{colour(m, "diffuse", {})}, specular{colour(m, "specular", {1, 1, 1})};
  if (type == "diffuse") return Diffuse{diffuse};
  if (type == "phong") return Phong{diffuse, specular, m["exponent"]};
  std::optional<TexturedFloat> alphaV;
  if (m.contains("alphaV")) alphaV = TexturedFloat{m["alphaV"].get<double>()};
  if (type.starts_with("principled")) return principledOf(m);
  if (type.ends_with("conductor")) {
    return Conductor{
        colour(m, "eta", {}), colour(m, "k", {}), m.contains("material"), specular, alpha, distribution, alphaV};
  }
  if (type.ends_with("dielectric")) {
    return Dielectric{m["intIor"],  m["extIor"],
                      specular,     TexturedRgb{colour(m, "transmittance", {1, 1, 1})},
                      alpha,        type.starts_with("thin"),
                      distribution, alphaV};
  }
  if (type.ends_with("plastic")) {
    return Plastic{m["intIor"], m["extIor"], diffuse, specular, alpha, m["nonlinear"], distribution};
  }
  throw std::runtime_error("bsdf.json: unknown type " + type);
}

std::optional<double> opacityOf(const Json& m) {
  return m.contains("opacity") ? std::optional(m["opacity"].get<double>()) : std::nullopt;
}

BsdfCase caseOf(const Json& entry) {
  const Json& m = entry["material"];
  if (m["type"] == "blendbsdf") {
    std::vector<Material> parts;
    for (const Json& part : m["parts"]) parts.push_back(partOf(kindOf(part), opacityOf(part)));
    const double weight = m["weight"];
    return blendCase("", {1 - weight, weight}, parts, true, opacityOf(m));
  }
  BsdfCase bsdf = bsdfCase("", kindOf(m), true, opacityOf(m));
  // Mitsuba fits a polynomial to the integral that we evaluate.
  if (entry.contains("fdrInt")) bsdf.tables->materials.front().internalDiffuse = entry["fdrInt"];
  return bsdf;
}

// Mitsuba's frame has dp/du along x.
Direction directionOf(const Json& json, const BsdfCase& bsdf) {
  const auto v = json.get<Direction>();
  if (bsdf.compounds == nullptr) return v;
  return {kTangent[0] * v[0] - kTangent[1] * v[1], kTangent[1] * v[0] + kTangent[0] * v[1], v[2]};
}

struct Tolerance {
  double value, pdf;  // relative
};
// Mitsuba computes in float. Its table of a rough plastic's transmittance T comes from a coarser quadrature than ours:
// T differs by up to 5e-4, and so by up to 1 % does 1 - T, which decides how often the specular lobe is drawn.
Tolerance toleranceOf(const Json& material) {
  // Densities of Beckmann normals are exact here and have a fit of G1 there.
  if (material["type"] != "roughplastic" && material.value("distribution", "") == "beckmann") return {1e-4, 4e-3};
  return material["type"] == "roughplastic" ? Tolerance{4e-3, 1e-2} : Tolerance{1e-4, 1e-4};
}

TEST_P(BsdfGoldenTest, valuesAndDensitiesAreMitsubas) {
  size_t compared = 0;
  for (const Json& entry : golden()["records"]) {
    const BsdfCase bsdf = caseOf(entry);
    // Which lobe of a principled BSDF is sampled how often is ours.
    const bool sampledAlike = !bsdf.isAmong(bitOf(BsdfKind::principled) | bitOf(BsdfKind::principledThin));
    const Tolerance tolerance = toleranceOf(entry["material"]);
    for (const Json& item : entry["values"]) {
      SCOPED_TRACE(entry["material"].dump() + item.dump());
      const std::vector<Direction> wi{directionOf(item["wi"], bsdf)}, wo{directionOf(item["wo"], bsdf)};
      for (const Precision precision : {Precision::floating, Precision::doubled}) {
        const auto value =
            evaluate(entries<BsdfEntries>(),
                     {.material = &bsdf.record, .compounds = bsdf.compounds, .precision = precision}, wi, wo)
                .front();
        const double pdf = item["pdf"];
        if (sampledAlike) {
          ASSERT_NEAR(value.pdf, pdf, tolerance.pdf * pdf + 1e-6);
        }
        for (size_t k = 0; k < 3; ++k) {
          const double expected = item["fCos"][k];
          ASSERT_NEAR(value.f[k] * std::abs(wo[0][2]), expected, tolerance.value * expected + 1e-6);
        }
        compared += pdf > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(compared, 1000u);
}

TEST_P(BsdfGoldenTest, deltaLobesAreMitsubas) {
  size_t compared = 0;
  for (const Json& entry : golden()["records"]) {
    const BsdfCase bsdf = caseOf(entry);
    // Mitsuba's blends, and what is in them, share out their numbers in another order.
    if (bsdf.isAmong(kBlendKinds)) continue;
    for (const Json& item : entry["deltas"]) {
      SCOPED_TRACE(entry["material"].dump() + item.dump());
      const std::vector<Direction> wi{directionOf(item["wi"], bsdf)};
      std::vector<std::array<float, 3>> u{{item["u"].get<float>(), 0.3f, 0.6f}};
      // Mitsuba's mask passes light on for large numbers, as we do, and its lobes come in our order.
      BsdfDraw draw{};
      entries<BsdfEntries>().sample({.material = &bsdf.record, .precision = Precision::doubled}, wi, u, &draw);
      const double weight = item["weight"][0];
      if (weight == 0) {
        EXPECT_EQ(draw.weight[0], 0);
        continue;
      }
      ASSERT_TRUE(draw.specular);
      ASSERT_NEAR(draw.pdf, item["pdf"], 1e-5);
      ASSERT_NEAR(1 / draw.etaRatio, item["eta"], 1e-5);
      for (size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(draw.wo[k], item["wo"][k], 1e-5);
        ASSERT_NEAR(draw.weight[k], item["weight"][k], 1e-4 * weight);
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 40u);
}

}  // namespace
}  // namespace wavecrest
