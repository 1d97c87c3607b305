// Parameters and defaults are those of the Mitsuba 3 plugin of the same name; `phong` is that of Mitsuba 0.6.
#include "engine/load/bsdfs.h"

#include <algorithm>
#include <cmath>

#include "engine/load/color.h"
#include "engine/load/ior_table.h"
#include "engine/load/materials.h"
#include "engine/load/values.h"
#include "engine/scene/texture_mean.h"

namespace wavecrest {

namespace {

// The least roughness of Mitsuba, below which it does not evaluate its microfacet model.
constexpr double kLeastAlpha = 1e-4;

// " (effect)" for messages with --lenient, which says what stands in for what is left out; empty without it.
std::string onlyLenient(const LoadContext& context, const std::string& effect) {
  return context.options.lenient ? " (" + effect + ")" : "";
}

// The mean of all values of a texture, of a checkerboard that of its two colours.
double meanValueOf(const Texture& texture) {
  const Rgb colour = mean(texture);
  return (colour[0] + colour[1] + colour[2]) / 3;
}

// The microfacet distribution, which is Beckmann by default.
Distribution readDistribution(LoadContext& context, Parameters& parameters) {
  const std::string name = toLower(parameters.string("distribution", "beckmann"));
  parameters.ignore({"sample_visible"});  // how to sample, not what
  if (name == "ggx") return Distribution::ggx;
  if (name == "beckmann") return Distribution::beckmann;
  if (name == "phong" || name == "as") {  // of 0.6, whose exponent for an alpha makes it as wide as Beckmann's
    context.unsupported(parameters.locationOf("distribution"),
                        "distribution " + inQuotes(name) + " of Mitsuba 0.6 is not supported" +
                            onlyLenient(context, "replaced by beckmann") +
                            "; expected beckmann of the same alpha, the nearest, or ggx");
    return Distribution::beckmann;
  }
  throw LoadError(parameters.locationOf("distribution"),
                  "unknown distribution " + inQuotes(name) + "; expected beckmann or ggx");
}

// Roughness of a microfacet distribution: `alpha` along dp/du, and `alphaV` across it if it differs.
struct Roughness {
  TexturedFloat alpha;
  std::optional<TexturedFloat> alphaV;
};
// Reads `alpha`, or `alpha_u` and `alpha_v`. If the two are equal, the result is isotropic.
Roughness readRoughness(LoadContext& context, Parameters& parameters) {
  const auto read = [&](const char* name) {
    TexturedFloat alpha = readTexturedFloat(context, parameters, name, 0.1);
    if (alpha.texture == kNone) alpha.value = std::max(alpha.value, kLeastAlpha);
    return alpha;
  };
  // alpha_u and alpha_v come together, and exclude alpha.
  const bool hasU = parameters.has("alpha_u"), hasV = parameters.has("alpha_v");
  if (hasU != hasV) {
    throw LoadError(parameters.locationOf(hasU ? "alpha_u" : "alpha_v"),
                    "one of alpha_u and alpha_v is missing; expected both or neither");
  }
  if (!hasU) return {.alpha = read("alpha"), .alphaV = {}};
  if (parameters.has("alpha")) {
    throw LoadError(parameters.locationOf("alpha"), "alpha stands beside alpha_u; expected one of the two");
  }
  Roughness roughness{.alpha = read("alpha_u"), .alphaV = read("alpha_v")};
  if (roughness.alpha.value == roughness.alphaV->value && roughness.alpha.texture == roughness.alphaV->texture) {
    roughness.alphaV.reset();
  }
  return roughness;
}

// The roughness of a BSDF that cannot be anisotropic. LoadError if alpha_u and alpha_v differ.
TexturedFloat readAlpha(LoadContext& context, Parameters& parameters) {
  const Roughness roughness = readRoughness(context, parameters);
  if (roughness.alphaV) {
    throw LoadError(parameters.locationOf("alpha_v"), parameters.describe() + " is isotropic; expected alpha");
  }
  return roughness.alpha;
}

// An index of refraction for each channel: a real one, or a part of a complex one.
Rgb readIndexColor(LoadContext& context, Parameters& parameters, std::string_view name, const Rgb& fallback) {
  const XmlElement* element = parameters.element(name);
  if (!element) return fallback;
  return readColor(context, *element, ColorRole::refraction);
}

// The parameters that `conductor` and `roughconductor` share. In files of 0.4 to 0.6 the material is copper by
// default, eta and k stand in for its own one by one, and both are those of the metal in a vacuum, with air outside.
Conductor readAnyConductor(LoadContext& context, Parameters& parameters) {
  Conductor conductor;
  const bool legacy = parameters.object().legacy;
  const std::string material = parameters.string("material", legacy ? "Cu" : "none");
  const bool hasEta = parameters.has("eta"), hasK = parameters.has("k");
  // The complex index of refraction: that of a named metal, or eta and k.
  ComplexIor ior{.eta = {0, 0, 0}, .k = {1, 1, 1}};
  if (toLower(material) != "none") {
    if ((hasEta || hasK) && !legacy) {
      throw LoadError(parameters.locationOf(hasEta ? "eta" : "k"),
                      "eta and k stand beside a material; expected one of the two");
    }
    const std::optional<ComplexIor> found = findConductor(material);
    if (!found) {
      throw LoadError(parameters.locationOf("material"),
                      "unknown conductor " + inQuotes(material) + "; expected one of " + listConductorNames());
    }
    ior = *found;
  }
  conductor.eta = readIndexColor(context, parameters, "eta", ior.eta);
  conductor.k = readIndexColor(context, parameters, "k", ior.k);
  // Fresnel's factor for eta = 0 is 1 at every angle, whatever k.
  conductor.perfectMirror = conductor.eta == Rgb{0, 0, 0};
  if (legacy || parameters.has("ext_eta")) {
    const double outside = parameters.ior("ext_eta", "air");
    // Fresnel's equations need the index relative to that of the outside.
    conductor.eta = (1 / outside) * conductor.eta;
    conductor.k = (1 / outside) * conductor.k;
  }
  conductor.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  return conductor;
}

// The parameters that `dielectric`, `thindielectric` and `roughdielectric` share.
Dielectric readAnyDielectric(LoadContext& context, Parameters& parameters) {
  Dielectric dielectric;
  dielectric.intIor = parameters.ior("int_ior", "bk7");
  dielectric.extIor = parameters.ior("ext_ior", "air");
  dielectric.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  dielectric.specularTransmittance = readTexturedRgb(context, parameters, "specular_transmittance", 1);
  return dielectric;
}

// The parameters that `plastic` and `roughplastic` share.
Plastic readAnyPlastic(LoadContext& context, Parameters& parameters) {
  Plastic plastic;
  plastic.intIor = parameters.ior("int_ior", "polypropylene");
  plastic.extIor = parameters.ior("ext_ior", "air");
  plastic.diffuseReflectance = readTexturedRgb(context, parameters, "diffuse_reflectance", 0.5);
  plastic.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  plastic.nonlinear = parameters.boolean("nonlinear", false);
  return plastic;
}

// Whether light passes through the surface, by its BSDF or because of its opacity.
bool transmits(const Material& material, const Scene& scene) {
  if (material.opacity || std::holds_alternative<Dielectric>(material.kind)) return true;
  if (const auto* principled = std::get_if<Principled>(&material.kind)) {
    return principled->thin || principled->specTrans.texture != kNone || principled->specTrans.value != 0;
  }
  const auto* blend = std::get_if<Blend>(&material.kind);
  return blend != nullptr &&
         std::ranges::any_of(blend->materials, [&](uint32_t part) { return transmits(scene.materials[part], scene); });
}

// For adapters that a material can have only once. With --lenient the inner one stays.
void refuseTwice(LoadContext& context, const Parameters& parameters) {
  context.unsupported(parameters.location(), parameters.describe() + " is nested in another one" +
                                                 onlyLenient(context, "left out") + "; expected it once");
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
  conductor.distribution = readDistribution(context, parameters);
  const Roughness roughness = readRoughness(context, parameters);
  conductor.alpha = roughness.alpha;
  conductor.alphaV = roughness.alphaV;
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
  dielectric.distribution = readDistribution(context, parameters);
  const Roughness roughness = readRoughness(context, parameters);
  dielectric.alpha = roughness.alpha;
  dielectric.alphaV = roughness.alphaV;
  material.kind = dielectric;
}

void readPlastic(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = readAnyPlastic(context, parameters);
}

void readRoughPlastic(LoadContext& context, Parameters& parameters, Material& material) {
  Plastic plastic = readAnyPlastic(context, parameters);
  plastic.distribution = readDistribution(context, parameters);
  plastic.alpha = readAlpha(context, parameters);
  // As in Mitsuba 3, where roughplastic takes only a number.
  if (plastic.alpha.texture != kNone) {
    context.unsupported(
        parameters.locationOf("alpha"),
        "alpha of roughplastic is a texture" + onlyLenient(context, "replaced by its mean") + "; expected one number");
    plastic.alpha = {.value = std::max(meanValueOf(context.scene.textures[plastic.alpha.texture]), kLeastAlpha)};
  }
  material.kind = plastic;
}

namespace {

// The exponent of `phong`, which in Mitsuba 0.6 may be a texture.
double readExponent(LoadContext& context, Parameters& parameters) {
  const XmlElement* const element = parameters.element("exponent");
  if (element == nullptr || element->tag != "texture") return parameters.positiveReal("exponent", 30);
  context.unsupported(
      parameters.locationOf("exponent"),
      "exponent of phong is a texture" + onlyLenient(context, "replaced by its mean") + "; expected one number");
  const TexturedFloat exponent = readTexturedFloat(context, parameters, "exponent", 30);
  const double mean =
      exponent.texture == kNone ? exponent.value : meanValueOf(context.scene.textures[exponent.texture]);
  return std::max(mean, 1e-4);
}

}  // namespace

void readPhong(LoadContext& context, Parameters& parameters, Material& material) {
  material.kind = Phong{.diffuseReflectance = readTexturedRgb(context, parameters, "diffuse_reflectance", 0.5),
                        .specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 0.2),
                        .exponent = readExponent(context, parameters)};
}

namespace {

// For a BSDF of 0.6 that is not supported: an error that names the nearest one, or with --lenient a warning.
void replaceBsdf(LoadContext& context, const Parameters& parameters, const std::string& nearest) {
  context.unsupported(parameters.location(), parameters.describe() + " of Mitsuba 0.6 is not supported" +
                                                 onlyLenient(context, "replaced by the nearest") + "; expected " +
                                                 nearest + ", the nearest");
}

}  // namespace

// Oren-Nayar's BSDF, which is diffuse for an alpha of 0.
void readRoughDiffuse(LoadContext& context, Parameters& parameters, Material& material) {
  const TexturedFloat alpha = readTexturedFloat(context, parameters, "alpha", 0.2);
  parameters.ignore({"use_fast_approx"});
  if (alpha.texture != kNone || alpha.value != 0) {
    replaceBsdf(context, parameters, "a bsdf \"diffuse\" of the same reflectance");
  }
  material.kind = Diffuse{.reflectance = readTexturedRgb(context, parameters, "reflectance", 0.5)};
}

// Ward's lobe is a Gaussian of the half vector's slope, as wide as a power of the cosine of 2 / alpha^2.
void readWard(LoadContext& context, Parameters& parameters, Material& material) {
  parameters.ignore({"variant"});
  const Roughness roughness = readRoughness(context, parameters);
  const double u = roughness.alpha.value, v = roughness.alphaV ? roughness.alphaV->value : u;
  const double exponent = 2 / std::max(u * v, 1e-8);
  replaceBsdf(context, parameters,
              "a bsdf \"phong\" of the same reflectances and of exponent " + std::to_string(std::lround(exponent)));
  material.kind = Phong{.diffuseReflectance = readTexturedRgb(context, parameters, "diffuse_reflectance", 0.5),
                        .specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 0.2),
                        .exponent = exponent};
}

// The adapters below read the nested BSDF into `material`, and then set what they add to it.
void readTwoSided(LoadContext& context, Parameters& parameters, Material& material) {
  const std::vector<const XmlElement*> sides = parameters.objects("bsdf");
  // One BSDF for both sides; a file may also refer to it twice.
  if (sides.size() == 2 && sides[0] != sides[1]) {
    context.unsupported(parameters.location(),
                        "two different BSDFs on the two sides are not supported; expected one nested BSDF");
  } else if (sides.empty() || sides.size() > 2) {
    throw LoadError(parameters.location(), parameters.describe() + " contains " + std::to_string(sides.size()) +
                                               " objects <bsdf>; expected exactly 1");
  }
  readBsdf(context, *sides.front(), material);
  // Mitsuba refuses these too.
  if (transmits(material, context.scene)) {
    throw LoadError(parameters.location(), "twosided around a BSDF that transmits; expected one that only reflects");
  }
  material.twoSided = true;
  material.normalMapping.aroundTwoSided = false;  // the map is within this one, also where it is around another
}

// A surface that does not change light: any BSDF with an opacity of 0.
void readNull(LoadContext&, Parameters&, Material& material) {
  material.kind = Diffuse{};
  material.opacity = TexturedFloat{0};
}

void readMask(LoadContext& context, Parameters& parameters, Material& material) {
  TexturedFloat opacity = readTexturedFloat(context, parameters, "opacity", 0.5);
  opacity.value = std::clamp(opacity.value, 0.0, 1.0);  // as Mitsuba does with each of nested masks
  if (parameters.object().legacy && isColored(context, parameters, "opacity")) {
    context.note(parameters.locationOf("opacity"), "coloured opacity of a mask",
                 "one number for all channels, where Mitsuba 0.6 has one for each");
  }
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  // Opacities of nested masks multiply. This works only for numbers, as a material has one texture for its opacity.
  if (!material.opacity) {
    material.opacity = opacity;
  } else if (material.opacity->texture == kNone && opacity.texture == kNone) {
    material.opacity->value *= opacity.value;
  } else {
    refuseTwice(context, parameters);
  }
}

// Reads the parameters that `bumpmap` and `normalmap` share. The nested BSDF must be in `material` already. In files of
// 0.4 to 0.6, which know neither of the two, mapped normals stay as they are and darken nothing. Returns whether the
// map applies: not if the nested BSDF has one.
bool readNormalMapping(LoadContext& context, Parameters& parameters, Material& material) {
  const bool byDefault = !parameters.object().legacy;
  const NormalMapping mapping{.flipInvalidNormals = parameters.boolean("flip_invalid_normals", byDefault),
                              .shadowing = parameters.boolean("use_shadowing_function", byDefault),
                              .aroundTwoSided = material.twoSided};
  if (material.hasMap()) {
    refuseTwice(context, parameters);
    return false;
  }
  material.normalMapping = mapping;
  return true;
}

// Whether a texture has steps and no slopes between them.
bool isFlat(const Texture& texture) {
  const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
  return bitmap == nullptr || bitmap->filter == Filter::nearest;
}

void readBumpMap(LoadContext& context, Parameters& parameters, Material& material) {
  // Heights are the luminances of a coloured bitmap, in all versions of Mitsuba.
  const uint32_t heights = textureOf(context, parameters.onlyObject("texture"));
  const uint32_t texture = scalarTextureOf(context, heights, true);
  if (isFlat(context.scene.textures[texture])) {
    context.note(parameters.location(), "bumpmap of a checkerboard, or of a bitmap with filter_type nearest",
                 "no bumps: heights have steps and no slopes");
  }
  const double scale = parameters.real("scale", 1);
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  if (!readNormalMapping(context, parameters, material)) return;
  material.bumpTexture = texture;
  material.bumpScale = scale;
}

void readNormalMap(LoadContext& context, Parameters& parameters, Material& material) {
  const uint32_t texture = textureOf(context, parameters.onlyObject("texture"));
  // In Mitsuba 0.6 the name of the texture is free.
  if (!parameters.has("normalmap") && !parameters.object().legacy) {
    throw LoadError(parameters.location(), "normalmap has no texture; expected one with name=\"normalmap\"");
  }
  readBsdf(context, parameters.onlyObject("bsdf"), material);
  if (!readNormalMapping(context, parameters, material)) return;
  material.normalTexture = texture;
}

}  // namespace wavecrest
