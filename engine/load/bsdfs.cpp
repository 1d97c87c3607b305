// Parameters and defaults are those of the Mitsuba 3 plugin of the same name; `phong` is that of Mitsuba 0.6.
#include "engine/load/bsdfs.h"

#include <algorithm>

#include "engine/load/color.h"
#include "engine/load/ior_table.h"
#include "engine/load/materials.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

Distribution readDistribution(Parameters& parameters) {
  const std::string name = toLower(parameters.string("distribution", "beckmann"));
  parameters.ignore({"sample_visible"});  // how to sample, not what
  if (name == "ggx") return Distribution::ggx;
  if (name == "beckmann") return Distribution::beckmann;
  throw LoadError(parameters.locationOf("distribution"),
                  "unknown distribution " + inQuotes(name) + "; expected beckmann or ggx");
}

TexturedFloat readAlpha(LoadContext& context, Parameters& parameters) {
  constexpr double kSmallest = 1e-4;  // Mitsuba's, below which its microfacet model is not evaluated
  TexturedFloat alpha = readTexturedFloat(context, parameters, "alpha", 0.1);
  const bool hasU = parameters.has("alpha_u"), hasV = parameters.has("alpha_v");
  if (hasU != hasV) {
    throw LoadError(parameters.locationOf(hasU ? "alpha_u" : "alpha_v"),
                    "one of alpha_u and alpha_v is missing; expected both or neither");
  }
  if (hasU) {
    if (parameters.has("alpha")) {
      throw LoadError(parameters.locationOf("alpha"), "alpha stands beside alpha_u; expected one of the two");
    }
    alpha = readTexturedFloat(context, parameters, "alpha_u", 0.1);
    const TexturedFloat alphaV = readTexturedFloat(context, parameters, "alpha_v", 0.1);
    if (alpha.value != alphaV.value || alpha.texture != alphaV.texture) {
      context.unsupported(parameters.locationOf("alpha_v"),
                          "anisotropic roughness is not supported; expected alpha_u equal to alpha_v");
    }
  }
  if (alpha.texture == kNone) alpha.value = std::max(alpha.value, kSmallest);
  return alpha;
}

Rgb readIndexColor(LoadContext& context, Parameters& parameters, std::string_view name, double fallback) {
  const XmlElement* element = parameters.element(name);
  if (!element) return {fallback, fallback, fallback};
  return readColor(context, *element, ColorRole::unbounded);
}

Conductor readAnyConductor(LoadContext& context, Parameters& parameters) {
  Conductor conductor;
  const std::string material = parameters.string("material", "none");
  const bool hasEta = parameters.has("eta"), hasK = parameters.has("k");
  if (material != "none") {
    if (hasEta || hasK) {
      throw LoadError(parameters.locationOf(hasEta ? "eta" : "k"),
                      "eta and k stand beside a material; expected one of the two");
    }
    const std::optional<ComplexIor> ior = findConductor(material);
    if (!ior) {
      throw LoadError(parameters.locationOf("material"),
                      "unknown conductor " + inQuotes(material) + "; expected one of " + listConductorNames());
    }
    conductor.eta = ior->eta;
    conductor.k = ior->k;
  } else {
    conductor.eta = readIndexColor(context, parameters, "eta", 0);
    conductor.k = readIndexColor(context, parameters, "k", 1);
    // Fresnel's factor for eta = 0 is 1 at every angle, whatever k.
    conductor.perfectMirror = conductor.eta == Rgb{0, 0, 0};
  }
  conductor.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  return conductor;
}

Dielectric readAnyDielectric(LoadContext& context, Parameters& parameters) {
  Dielectric dielectric;
  dielectric.intIor = parameters.ior("int_ior", "bk7");
  dielectric.extIor = parameters.ior("ext_ior", "air");
  dielectric.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  dielectric.specularTransmittance = readTexturedRgb(context, parameters, "specular_transmittance", 1);
  return dielectric;
}

Plastic readAnyPlastic(LoadContext& context, Parameters& parameters) {
  Plastic plastic;
  plastic.intIor = parameters.ior("int_ior", "polypropylene");
  plastic.extIor = parameters.ior("ext_ior", "air");
  plastic.diffuseReflectance = readTexturedRgb(context, parameters, "diffuse_reflectance", 0.5);
  plastic.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  plastic.nonlinear = parameters.boolean("nonlinear", false);
  return plastic;
}

bool transmits(const Material& material) { return std::holds_alternative<Dielectric>(material.kind); }

[[noreturn]] void failTwice(const Parameters& parameters) {
  throw LoadError(parameters.location(), parameters.describe() + " is nested in another one; expected it once");
}

}  // namespace

void readDiffuse(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = Diffuse{.reflectance = readTexturedRgb(context, parameters, "reflectance", 0.5)};
}

void readConductor(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = readAnyConductor(context, parameters);
}

void readRoughConductor(LoadContext& context, Parameters& parameters, Material& material) {
  Conductor conductor = readAnyConductor(context, parameters);
  conductor.distribution = readDistribution(parameters);
  conductor.alpha = readAlpha(context, parameters);
  material.kind = conductor;
}

void readDielectric(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = readAnyDielectric(context, parameters);
}

void readThinDielectric(LoadContext& context, Parameters& parameters, Material& material) {
  Dielectric dielectric = readAnyDielectric(context, parameters);
  dielectric.thin = true;
  material.kind = dielectric;
}

void readRoughDielectric(LoadContext& context, Parameters& parameters, Material& material) {
  Dielectric dielectric = readAnyDielectric(context, parameters);
  dielectric.distribution = readDistribution(parameters);
  dielectric.alpha = readAlpha(context, parameters);
  material.kind = dielectric;
}

void readPlastic(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = readAnyPlastic(context, parameters);
}

void readRoughPlastic(LoadContext& context, Parameters& parameters, Material& material) {
  Plastic plastic = readAnyPlastic(context, parameters);
  plastic.distribution = readDistribution(parameters);
  plastic.alpha = readAlpha(context, parameters);
  if (plastic.alpha.texture != kNone) {
    throw LoadError(parameters.locationOf("alpha"), "alpha of roughplastic is a texture; expected one number");
  }
  material.kind = plastic;
}

void readPhong(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = Phong{.diffuseReflectance = readTexturedRgb(context, parameters, "diffuse_reflectance", 0.5),
                        .specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 0.2),
                        .exponent = parameters.positiveReal("exponent", 30)};
}

void readTwoSided(LoadContext& context, Parameters& parameters, Material& material) {
  const std::vector<const XmlElement*> sides = parameters.objects("bsdf");
  if (sides.size() == 2 && sides[0] != sides[1]) {
    context.unsupported(parameters.location(),
                        "two different BSDFs on the two sides are not supported; expected one nested BSDF");
  } else if (sides.empty() || sides.size() > 2) {
    throw LoadError(parameters.location(), parameters.describe() + " contains " + std::to_string(sides.size()) +
                                               " objects <bsdf>; expected exactly 1");
  }
  if (material.twoSided) failTwice(parameters);
  readBsdf(context, *sides.front(), material);
  if (transmits(material) || material.opacity) {
    throw LoadError(parameters.location(), "twosided around a BSDF that transmits; expected one that only reflects");
  }
  material.twoSided = true;
}

void readMask(LoadContext& context, Parameters& parameters, Material& material) {
  const TexturedFloat opacity = readTexturedFloat(context, parameters, "opacity", 0.5);
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  if (material.opacity) failTwice(parameters);
  material.opacity = opacity;
}

// What bump and normal maps have in common; the nested BSDF has been read.
void readNormalMapping(Parameters& parameters, Material& material) {
  if (material.bumpTexture != kNone || material.normalTexture != kNone) failTwice(parameters);
  material.normalMapping = {.flipInvalidNormals = parameters.boolean("flip_invalid_normals", true),
                            .shadowing = parameters.boolean("use_shadowing_function", true),
                            .aroundTwoSided = material.twoSided};
}

void readBumpMap(LoadContext& context, Parameters& parameters, Material& material) {
  const uint32_t texture = scalarTextureOf(context, textureOf(context, parameters.onlyObject("texture")));
  const double scale = parameters.real("scale", 1);
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  readNormalMapping(parameters, material);
  material.bumpTexture = texture;
  material.bumpScale = scale;
}

void readNormalMap(LoadContext& context, Parameters& parameters, Material& material) {
  const uint32_t texture = textureOf(context, parameters.onlyObject("texture"));
  if (!parameters.has("normalmap")) {
    throw LoadError(parameters.location(), "normalmap has no texture; expected one with name=\"normalmap\"");
  }
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  readNormalMapping(parameters, material);
  material.normalTexture = texture;
}

}  // namespace wavecrest
