#include "engine/compile/materials.h"

#include <algorithm>
#include <cmath>

#include "engine/compile/material_kinds.h"
#include "engine/compile/overloaded.h"
#include "engine/compile/rough_boundary.h"
#include "engine/compile/texture_bounds.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// Where a rough boundary hardly bends light, the half vector of a refraction is a difference of nearly equal numbers.
// Index ratios closer to 1 than this are compiled as if they were this far from it, which moves no direction by more
// than about as much. Even at a ratio of 1 the boundary differs from none: its facets still shadow each other.
constexpr double kIndexMatched = 1e-4;

// Least probability of sampling either lobe of a plastic or phong with a textured colour. A texture with a mean near 0
// may have bright texels; a probability that follows the mean would be too small for random numbers of 24 bits.
constexpr float kLeastShare = 1.0f / 16;

// Mitsuba 0.6 scales the colours of a phong whose sum is above 1 in a channel down to this sum.
constexpr double kPhongEnergy = 0.99;

bool isNearlyZero(const TexturedFloat& alpha) { return alpha.texture == kNone && alpha.value < kSmallestAlpha; }

// The ratio, or the nearest on its side of 1 that is kIndexMatched away from 1.
double awayFromMatched(double ratio) {
  if (std::abs(ratio - 1) >= kIndexMatched) return ratio;
  return ratio < 1 ? 1 - kIndexMatched : 1 + kIndexMatched;
}

// Interior over exterior index; of a rough boundary kept kIndexMatched away from 1.
double relativeIor(const Dielectric& dielectric) {
  const double ratio = dielectric.intIor / dielectric.extIor;
  return dielectric.thin || isSmooth(dielectric) ? ratio : awayFromMatched(ratio);
}
// The index of a principled BSDF, kept as far from 1 where light is refracted.
double relativeIor(const Principled& principled) {
  const bool transmits = principled.specTrans.texture != kNone || principled.specTrans.value != 0;
  return principled.thin || !transmits ? principled.eta : awayFromMatched(principled.eta);
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
    record_.eta[0] = static_cast<float>(relativeIor(principled));
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
    record_.specularPick = specularShare(plastic.specularReflectance, plastic.diffuseReflectance, average);
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
    // Mitsuba's limit on the sum of both colours, by their maxima where they are textured.
    const double brightest =
        std::ranges::max(greatest(phong.diffuseReflectance, scene_) + greatest(phong.specularReflectance, scene_));
    if (brightest > 1) {
      const auto scale = static_cast<float>(kPhongEnergy / brightest);
      for (float& channel : record_.reflectance) channel *= scale;
      for (float& channel : record_.specular) channel *= scale;
    }
    const auto luminanceOf = [](const Rgb& colour) { return luminance(colour); };
    record_.specularPick = specularShare(phong.specularReflectance, phong.diffuseReflectance, luminanceOf);
  }

 private:
  // The probability of sampling the specular lobe: its mean colour over the sum of both means, as numbers by
  // `toNumber`. That of a black material does not matter.
  template <class ToNumber>
  float specularShare(const TexturedRgb& specular, const TexturedRgb& diffuse, const ToNumber& toNumber) const {
    const double ofSpecular = toNumber(mean(specular, scene_)), sum = ofSpecular + toNumber(mean(diffuse, scene_));
    const float share = sum > 0 ? static_cast<float>(ofSpecular / sum) : 0.5f;
    const bool anyTexture = specular.texture != kNone || diffuse.texture != kNone;
    const auto isBlack = [&](const TexturedRgb& colour) { return !(std::ranges::max(greatest(colour, scene_)) > 0); };
    if (!anyTexture || isBlack(specular) || isBlack(diffuse)) return share;
    return std::clamp(share, kLeastShare, 1 - kLeastShare);
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
  // Light that is reflected again and again between base and boundary has to fade.
  const auto* plastic = std::get_if<Plastic>(&material.kind);
  if (plastic != nullptr && plastic->nonlinear) {
    const double most = std::ranges::max(greatest(plastic->diffuseReflectance, scene));
    if (most * record.internalDiffuse >= 1) {
      throw SceneError(material.source, "diffuse_reflectance of a nonlinear plastic has values up to " +
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
