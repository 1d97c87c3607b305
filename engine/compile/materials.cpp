#include "engine/compile/materials.h"

#include <algorithm>
#include <cmath>

#include "engine/compile/rough_boundary.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// Where a rough boundary hardly bends light, the half vector of a refraction is a difference of nearly equal numbers.
// Index ratios closer to 1 than this are compiled as if they were this far from it, which moves no direction by more
// than about as much. Even at a ratio of 1 the boundary differs from none: its facets still shadow each other.
constexpr double kIndexMatched = 1e-4;

// Mitsuba 0.6 scales the colours of a phong whose sum is above 1 in a channel down to this sum.
constexpr double kPhongEnergy = 0.99;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // which clang 14, that lints, does not find by itself

// ---- which kernel ---------------------------------------------------------------------------------------------------

bool isNearlyZero(const TexturedFloat& alpha) { return alpha.texture == kNone && alpha.value < kSmallestAlpha; }

// Interior over exterior index; of a rough boundary kept kIndexMatched away from 1.
double relativeIor(const Dielectric& dielectric) {
  const double ratio = dielectric.intIor / dielectric.extIor;
  if (dielectric.thin || isSmooth(dielectric) || std::abs(ratio - 1) >= kIndexMatched) return ratio;
  return ratio < 1 ? 1 - kIndexMatched : 1 + kIndexMatched;
}

// The kernel of a BSDF, by its roughness, distribution and anisotropy.
BsdfKind kindOf(const Diffuse&) { return BsdfKind::diffuse; }
BsdfKind kindOf(const Conductor& conductor) {
  if (conductor.alphaV) {
    return conductor.distribution == Distribution::ggx ? BsdfKind::anisotropicConductor
                                                       : BsdfKind::anisotropicBeckmannConductor;
  }
  if (isSmooth(conductor)) return BsdfKind::conductor;
  return conductor.distribution == Distribution::ggx ? BsdfKind::roughConductor : BsdfKind::beckmannConductor;
}
BsdfKind kindOf(const Dielectric& dielectric) {
  if (dielectric.thin) return BsdfKind::thinDielectric;
  if (dielectric.alphaV) {
    return dielectric.distribution == Distribution::ggx ? BsdfKind::anisotropicDielectric
                                                        : BsdfKind::anisotropicBeckmannDielectric;
  }
  if (isSmooth(dielectric)) return BsdfKind::dielectric;
  return dielectric.distribution == Distribution::ggx ? BsdfKind::roughDielectric : BsdfKind::beckmannDielectric;
}
BsdfKind kindOf(const Plastic& plastic) {
  if (isSmooth(plastic)) return BsdfKind::plastic;
  return plastic.distribution == Distribution::ggx ? BsdfKind::roughPlastic : BsdfKind::beckmannPlastic;
}
BsdfKind kindOf(const Phong&) { return BsdfKind::phong; }
BsdfKind kindOf(const Principled& principled) {
  return principled.thin ? BsdfKind::principledThin : BsdfKind::principled;
}

uint32_t lobesOf(BsdfKind kind);
BsdfKind kindOf(const Material& material, const Scene& scene, bool passes = false);

// The lobes of all parts of a blend together: kHasDelta and kHasFinite. passes: without what lets light straight on.
uint32_t lobesOf(const Blend& blend, const Scene& scene, bool passes) {
  uint32_t lobes = 0;
  for (const uint32_t index : blend.materials) {
    const Material& part = scene.materials[index];
    if (passes && isIndexMatched(part)) continue;
    lobes |= lobesOf(kindOf(part, scene)) | (part.opacity && !passes ? kHasDelta : 0u);
  }
  return lobes;
}
BsdfKind kindOf(const Material& material, const Scene& scene, bool passes) {
  return std::visit(Overloaded{[&](const Blend& blend) {
                                 return (lobesOf(blend, scene, passes) & kHasFinite) != 0 ? BsdfKind::blend
                                                                                          : BsdfKind::deltaBlend;
                               },
                               [](const auto& bsdf) { return kindOf(bsdf); }},
                    material.kind);
}

// Feature bits of the kernels that have a BSDF.
uint32_t featureOf(BsdfKind kind) {
  if ((bitOf(kind) & kCompoundKinds) != 0) return kCompoundBsdfs | kLayeredBsdfs | kSpecularBsdfs;
  switch (kind) {
    case BsdfKind::diffuse:
      return 0;
    case BsdfKind::conductor:
    case BsdfKind::dielectric:
    case BsdfKind::roughConductor:
      return kSpecularBsdfs;
    default:
      return kLayeredBsdfs | kSpecularBsdfs;  // kernels with the second have the first
  }
}

// The lobes of a BSDF itself: kHasDelta and kHasFinite.
uint32_t lobesOf(BsdfKind kind) {
  switch (kind) {
    case BsdfKind::conductor:
    case BsdfKind::dielectric:
    case BsdfKind::thinDielectric:
    case BsdfKind::deltaBlend:
      return kHasDelta;
    case BsdfKind::plastic:
      return kHasDelta | kHasFinite;
    default:
      return kHasFinite;
  }
}

// ---- means of textured values ---------------------------------------------------------------------------------------

// Mean over the texels of a bitmap, or of a checkerboard's two colours.
Rgb mean(const Texture& texture) {
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    Rgb sum{};
    for (size_t i = 0; i < 3; ++i) sum[i] = (checkerboard->color0[i] + checkerboard->color1[i]) / 2;
    return sum;
  }
  const Bitmap& bitmap = *std::get<BitmapTexture>(texture.kind).bitmap;
  Rgb sum{};
  const size_t pixels = size_t{bitmap.width} * bitmap.height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t i = 0; i < 3; ++i) sum[i] += bitmap.pixels[p * bitmap.channels + (bitmap.channels == 3 ? i : 0)];
  }
  for (double& channel : sum) channel /= static_cast<double>(std::max<size_t>(pixels, 1));
  return sum;
}

Rgb mean(const TexturedRgb& colour, const Scene& scene) {
  return colour.texture == kNone ? colour.value : mean(scene.textures[colour.texture]);
}

// The greatest value of any channel.
double greatest(const Texture& texture) {
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    return std::max(std::ranges::max(checkerboard->color0), std::ranges::max(checkerboard->color1));
  }
  const std::vector<float>& pixels = std::get<BitmapTexture>(texture.kind).bitmap->pixels;
  return pixels.empty() ? 0 : static_cast<double>(std::ranges::max(pixels));
}

double average(const Rgb& colour) { return (colour[0] + colour[1] + colour[2]) / 3; }

// ---- fields ---------------------------------------------------------------------------------------------------------

// Fills a slot that may be textured: with the constant, or with 1 and the texture's index.
void assignTextured(float (&out)[3], uint32_t& texture, const TexturedRgb& colour) {
  assign(out, colour.texture == kNone ? colour.value : Rgb{1, 1, 1});
  texture = colour.texture;
}
void assignTextured(float& out, uint32_t& texture, const TexturedFloat& value) {
  out = value.texture == kNone ? static_cast<float>(value.value) : 1.0f;
  texture = value.texture;
}

// Fills in the fields of one material; the kind is already set.
class Compiler {
 public:
  Compiler(MaterialRecord& record, const Scene& scene, bool passes) : record_(record), scene_(scene), passes_(passes) {}

  void operator()(const Diffuse& diffuse) {
    assignTextured(record_.reflectance, record_.reflectanceTexture, diffuse.reflectance);
  }

  void operator()(const Conductor& conductor) {
    // A real index of 0 makes Fresnel's factor 1 at all angles.
    assign(record_.eta, conductor.perfectMirror ? Rgb{0, 0, 0} : conductor.eta);
    assign(record_.k, conductor.perfectMirror ? Rgb{1, 1, 1} : conductor.k);
    assignTextured(record_.specular, record_.specularTexture, conductor.specularReflectance);
    assignTextured(record_.alpha, record_.alphaTexture, conductor.alpha);
  }

  void operator()(const Dielectric& dielectric) {
    record_.eta[0] = static_cast<float>(relativeIor(dielectric));
    assignTextured(record_.specular, record_.specularTexture, dielectric.specularReflectance);
    assignTextured(record_.transmittance, record_.transmittanceTexture, dielectric.specularTransmittance);
    assignTextured(record_.alpha, record_.alphaTexture, dielectric.alpha);
  }

  void operator()(const Principled& principled) {
    record_.eta[0] = static_cast<float>(principled.eta);
    assignTextured(record_.reflectance, record_.reflectanceTexture, principled.baseColor);
    assignTextured(record_.alpha, record_.alphaTexture, principled.roughness);
  }

  void operator()(const Blend& blend) { record_.flags |= lobesOf(blend, scene_, passes_); }

  void operator()(const Plastic& plastic) {
    const double eta = plastic.intIor / plastic.extIor;
    record_.eta[0] = static_cast<float>(eta);
    assignTextured(record_.reflectance, record_.reflectanceTexture, plastic.diffuseReflectance);
    assignTextured(record_.specular, record_.specularTexture, plastic.specularReflectance);
    assignTextured(record_.alpha, record_.alphaTexture, plastic.alpha);
    if (plastic.nonlinear) record_.flags |= kNonlinear;
    // How often the specular lobe is sampled.
    const double diffuse = average(mean(plastic.diffuseReflectance, scene_));
    const double specular = average(mean(plastic.specularReflectance, scene_));
    record_.specularPick = specularShare(specular, diffuse);
    // What the boundary reflects of diffuse light from inside, and the table of what it lets pass.
    if (isSmooth(plastic)) {
      record_.internalDiffuse = static_cast<float>(diffuseFresnelReflectance(1 / eta));
    } else {
      const RoughBoundary boundary{plastic.distribution, plastic.alpha.value, eta};
      record_.internalDiffuse = static_cast<float>(internalReflectance(boundary));
      std::ranges::copy(transmittanceTable(boundary), record_.roughTransmittance);
    }
  }

  void operator()(const Phong& phong) {
    assignTextured(record_.reflectance, record_.reflectanceTexture, phong.diffuseReflectance);
    assignTextured(record_.specular, record_.specularTexture, phong.specularReflectance);
    record_.alpha = static_cast<float>(phong.exponent);
    const Rgb diffuse = mean(phong.diffuseReflectance, scene_), specular = mean(phong.specularReflectance, scene_);
    // Mitsuba's limit on the sum of both colours, by their means where they are textured.
    double brightest = 0;
    for (size_t i = 0; i < 3; ++i) brightest = std::max(brightest, diffuse[i] + specular[i]);
    if (brightest > 1) {
      const auto scale = static_cast<float>(kPhongEnergy / brightest);
      for (float& channel : record_.reflectance) channel *= scale;
      for (float& channel : record_.specular) channel *= scale;
    }
    record_.specularPick = specularShare(luminance(specular), luminance(diffuse));
  }

 private:
  // Share of the samples that the specular lobe gets. That of a black material does not matter.
  static float specularShare(double specular, double diffuse) {
    return specular + diffuse > 0 ? static_cast<float>(specular / (specular + diffuse)) : 0.5f;
  }

  MaterialRecord& record_;
  const Scene& scene_;
  const bool passes_;
};

// Flags of how a material looks from behind, and of how its bump or normal map is applied.
uint32_t sidesOf(const Material& material) {
  if (!material.hasMap()) return material.twoSided ? uint32_t{kTwoSided} : 0u;
  const NormalMapping& mapping = material.normalMapping;
  uint32_t flags = kMapped;
  if (mapping.flipInvalidNormals) flags |= kFlipsNormals;
  if (mapping.shadowing) flags |= kSoftensTerminator;
  if (material.twoSided) flags |= mapping.aroundTwoSided ? kTwoSided : kMirrorsBack;
  return flags;
}

// Whether the material, or a part of it, has any texture.
bool isTextured(const Material& material, const Scene& scene) {
  // Whether any of these values has a texture, and the same of a roughness across dp/du.
  const auto textured = [](const auto&... values) { return ((values.texture != kNone) || ...); };
  const auto across = [&](const auto& bsdf) { return bsdf.alphaV && textured(*bsdf.alphaV); };
  const auto part = [&](uint32_t index) { return isTextured(scene.materials[index], scene); };
  const bool anyTexture = std::visit(
      Overloaded{[&](const Diffuse& d) { return textured(d.reflectance); },
                 [&](const Conductor& c) { return textured(c.specularReflectance, c.alpha) || across(c); },
                 [&](const Dielectric& d) {
                   return textured(d.specularReflectance, d.specularTransmittance, d.alpha) || across(d);
                 },
                 [&](const Plastic& p) { return textured(p.diffuseReflectance, p.specularReflectance, p.alpha); },
                 [&](const Phong& p) { return textured(p.diffuseReflectance, p.specularReflectance); },
                 [&](const Principled& p) {
                   return textured(p.baseColor, p.roughness, p.anisotropic, p.specTrans, p.specTint, p.sheen,
                                   p.sheenTint, p.flatness, p.metallic, p.clearcoat, p.clearcoatGloss, p.diffTrans);
                 },
                 [&](const Blend& b) {
                   return b.weightTexture != kNone || std::any_of(b.materials.begin(), b.materials.end(), part);
                 }},
      material.kind);
  return anyTexture || material.hasMap() || (material.opacity && textured(*material.opacity));
}

}  // namespace

bool isSmooth(const Conductor& conductor) { return !conductor.alphaV && isNearlyZero(conductor.alpha); }
bool isSmooth(const Dielectric& dielectric) { return !dielectric.alphaV && isNearlyZero(dielectric.alpha); }
bool isSmooth(const Plastic& plastic) { return isNearlyZero(plastic.alpha); }

bool isIndexMatched(const Material& material) {
  const auto* dielectric = std::get_if<Dielectric>(&material.kind);
  return dielectric != nullptr && (dielectric->thin || isSmooth(*dielectric)) &&
         static_cast<float>(relativeIor(*dielectric)) == 1.0f;
}

bool isAnisotropic(const Material& material, const Scene& scene) {
  const auto part = [&](uint32_t index) { return isAnisotropic(scene.materials[index], scene); };
  return std::visit(
      Overloaded{[](const Conductor& c) { return c.alphaV.has_value(); },
                 [](const Dielectric& d) { return d.alphaV.has_value(); },
                 [](const Principled& p) { return p.anisotropic.texture != kNone || p.anisotropic.value != 0; },
                 [&](const Blend& b) { return std::any_of(b.materials.begin(), b.materials.end(), part); },
                 [](const auto&) { return false; }},
      material.kind);
}

uint32_t materialFeatures(const Material& material, const Scene& scene) {
  uint32_t features = featureOf(kindOf(material, scene));
  if (material.opacity) features |= kLayeredBsdfs | kSpecularBsdfs;
  // Tangents come from texture coordinates.
  if (isTextured(material, scene) || isAnisotropic(material, scene)) features |= kTextures;
  if (material.hasMap()) features |= kTextures | kNormalMaps;
  return features;
}

MaterialRecord compileMaterial(const Material& material, const Scene& scene, bool passes) {
  MaterialRecord record{};
  const BsdfKind kind = kindOf(material, scene, passes);
  record.kind = static_cast<uint32_t>(kind);
  // Flags, and no textures yet.
  record.flags = lobesOf(kind);
  record.flags |= sidesOf(material);
  for (uint32_t* texture : {&record.reflectanceTexture, &record.specularTexture, &record.transmittanceTexture,
                            &record.alphaTexture, &record.opacityTexture}) {
    *texture = kNone;
  }
  record.normalTexture = material.normalTexture;
  record.bumpTexture = material.bumpTexture;
  record.bumpScale = static_cast<float>(material.bumpScale);
  // Opacity: what passes straight through is a delta lobe.
  record.opacity = 1;
  if (passes) record.flags |= kPasses;
  if (material.opacity && !passes) {
    assignTextured(record.opacity, record.opacityTexture, *material.opacity);
    record.opacity = std::clamp(record.opacity, 0.0f, 1.0f);
    if (record.opacity < 1 || record.opacityTexture != kNone) record.flags |= kHasDelta;
  }
  // The fields of this kind of BSDF.
  std::visit(Compiler(record, scene, passes), material.kind);
  // Light that is reflected again and again between base and boundary has to fade. Constants are at most 1.
  const auto* plastic = std::get_if<Plastic>(&material.kind);
  if (plastic != nullptr && plastic->nonlinear && plastic->diffuseReflectance.texture != kNone) {
    const double most = greatest(scene.textures[plastic->diffuseReflectance.texture]);
    if (most * record.internalDiffuse >= 1) {
      throw SceneError(material.source, "diffuse_reflectance texture of a nonlinear plastic has values up to " +
                                            std::to_string(most) + "; expected less than " +
                                            std::to_string(1 / record.internalDiffuse));
    }
  }
  return record;
}

CompoundRecord compileCompound(const Material& material) {
  CompoundRecord record{};
  // No textures yet.
  record.weightTexture = kNone;
  std::ranges::fill(record.texture, kNone);
  // Fills the slot of a parameter.
  const auto parameter = [&](CompoundParameter name, const TexturedFloat& value) {
    const auto k = static_cast<size_t>(name);
    assignTextured(record.value[k], record.texture[k], value);
  };
  const auto across = [&](const auto& bsdf) {
    if (bsdf.alphaV) parameter(CompoundParameter::alphaV, *bsdf.alphaV);
  };
  std::visit(Overloaded{[&](const Conductor& c) { across(c); }, [&](const Dielectric& d) { across(d); },
                        [&](const Principled& p) {
                          parameter(CompoundParameter::anisotropic, p.anisotropic);
                          parameter(CompoundParameter::metallic, p.metallic);
                          parameter(CompoundParameter::specTrans, p.specTrans);
                          parameter(CompoundParameter::specTint, p.specTint);
                          parameter(CompoundParameter::sheen, p.sheen);
                          parameter(CompoundParameter::sheenTint, p.sheenTint);
                          parameter(CompoundParameter::flatness, p.flatness);
                          parameter(CompoundParameter::clearcoat, p.clearcoat);
                          parameter(CompoundParameter::clearcoatGloss, p.clearcoatGloss);
                          parameter(CompoundParameter::diffTrans, p.diffTrans);
                        },
                        [&](const Blend& blend) {
                          if (blend.materials.size() > kMostParts) {
                            throw SceneError(material.source, "a blend of " + std::to_string(blend.materials.size()) +
                                                                  " BSDFs; expected at most " +
                                                                  std::to_string(kMostParts));
                          }
                          record.partCount = static_cast<uint32_t>(blend.materials.size());
                          std::ranges::copy(blend.materials, record.part);
                          for (size_t i = 0; i < blend.weights.size(); ++i) {
                            record.weight[i] = static_cast<float>(blend.weights[i]);
                          }
                          record.weightTexture = blend.weightTexture;
                        },
                        [](const auto&) {}},
             material.kind);
  return record;
}

double diffuseFresnelReflectance(double eta) {
  // Total reflection begins at cos^2 = 1 - eta^2, where F has a kink: it is integrated on either side of it, over
  // c = c0 + (1 - c0) t^2, which resolves the square root on the far side.
  const double kink = eta < 1 ? std::sqrt((1 - eta) * (1 + eta)) : 0;
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    // The cosine of incidence, that of refraction, and Fresnel's amplitudes for both polarisations.
    const double c = kink + (1 - kink) * t * t;
    const double cosT = std::sqrt(std::max(0.0, 1 - (1 - c * c) / (eta * eta)));
    const double rs = (c - eta * cosT) / (c + eta * cosT), rp = (eta * c - cosT) / (eta * c + cosT);
    // F times the weight 2 c and dc/dt.
    sum += 0.5 * (rs * rs + rp * rp) * 2 * c * 2 * t * (1 - kink);
  }
  // Below the kink F is 1, and the integral of 2 c is the square of the kink.
  return kink * kink + sum / kSteps;
}

}  // namespace wavecrest
