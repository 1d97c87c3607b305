#include "engine/load/simplify.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// ---- meshes ---------------------------------------------------------------------------------------------------------

bool isFlat(const Mesh& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<uint32_t, 3>& corners) {
    const Double3 p0 = widened(mesh.positions[corners[0]]);
    const Double3 across = cross(widened(mesh.positions[corners[1]]) - p0, widened(mesh.positions[corners[2]]) - p0);
    const double area = length(across);
    if (!(area > 0)) return true;  // cannot be hit
    return std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) {
      return dot(widened(mesh.normals[corner]), across) >= kFlatCosine * area;
    });
  });
}

// ---- textures -------------------------------------------------------------------------------------------------------

// The one colour of a texture, if it has one.
std::optional<Rgb> onlyColour(const Texture& texture) {
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    if (checkerboard->color0 == checkerboard->color1) return checkerboard->color0;
    return std::nullopt;
  }
  const auto* bitmapTexture = std::get_if<BitmapTexture>(&texture.kind);
  if (bitmapTexture == nullptr) return std::nullopt;
  const Bitmap& bitmap = *bitmapTexture->bitmap;
  const size_t channels = bitmap.channels;
  for (size_t i = channels; i < bitmap.pixels.size(); ++i) {
    if (bitmap.pixels[i] != bitmap.pixels[i % channels]) return std::nullopt;
  }
  if (bitmap.pixels.size() < channels) return std::nullopt;
  Rgb colour{};
  for (size_t c = 0; c < 3; ++c) colour[c] = static_cast<double>(bitmap.pixels[channels == 3 ? c : 0]);
  return colour;
}

class Simplifier {
 public:
  explicit Simplifier(const Scene& scene) {
    for (const Texture& texture : scene.textures) colours_.push_back(onlyColour(texture));
  }

  void operator()(TexturedRgb& value) const {
    if (const auto colour = colourOf(value.texture)) value = {*colour, kNone};
  }
  // Of a grey texture alone: how a coloured one becomes a number is the texture kernel's business.
  void operator()(TexturedFloat& value) const {
    const auto colour = colourOf(value.texture);
    if (colour && (*colour)[0] == (*colour)[1] && (*colour)[0] == (*colour)[2]) value = {(*colour)[0], kNone};
  }
  void operator()(Diffuse& diffuse) const { (*this)(diffuse.reflectance); }
  void operator()(Conductor& conductor) const {
    (*this)(conductor.specularReflectance);
    simplifyRoughness(conductor);
  }
  void operator()(Dielectric& dielectric) const {
    (*this)(dielectric.specularReflectance);
    (*this)(dielectric.specularTransmittance);
    simplifyRoughness(dielectric);
  }
  void operator()(Plastic& plastic) const {
    (*this)(plastic.diffuseReflectance);
    (*this)(plastic.specularReflectance);
    (*this)(plastic.alpha);
  }
  void operator()(Phong& phong) const {
    (*this)(phong.diffuseReflectance);
    (*this)(phong.specularReflectance);
  }
  void operator()(Principled& principled) const {
    (*this)(principled.baseColor);
    for (TexturedFloat* value :
         {&principled.roughness, &principled.anisotropic, &principled.specTrans, &principled.specTint,
          &principled.sheen, &principled.sheenTint, &principled.flatness, &principled.metallic, &principled.clearcoat,
          &principled.clearcoatGloss, &principled.diffTrans}) {
      (*this)(*value);
    }
  }
  // Without parts of no weight.
  void operator()(Blend& blend) const {
    if (blend.weightTexture != kNone) {
      TexturedFloat weight{0, blend.weightTexture};
      (*this)(weight);
      if (weight.texture != kNone) return;
      const double second = std::clamp(weight.value, 0.0, 1.0);
      blend.weightTexture = kNone;
      blend.weights = {1 - second, second};
    }
    for (size_t i = blend.materials.size(); i-- > 0;) {
      if (blend.weights[i] != 0 || blend.materials.size() == 1) continue;
      blend.materials.erase(blend.materials.begin() + static_cast<ptrdiff_t>(i));
      blend.weights.erase(blend.weights.begin() + static_cast<ptrdiff_t>(i));
    }
  }
  // Of other kinds of materials nothing is known here.
  template <class Kind>
  void operator()(Kind&) const {}

  void operator()(Material& material) const {
    std::visit([this](auto& kind) { (*this)(kind); }, material.kind);
    if (material.opacity) {
      (*this)(*material.opacity);
      if (material.opacity->texture == kNone && material.opacity->value >= 1) material.opacity.reset();
    }
    if (colourOf(material.bumpTexture)) material.bumpTexture = kNone;
    if (const auto normal = colourOf(material.normalTexture)) {
      if (*normal == Rgb{0.5, 0.5, 1}) material.normalTexture = kNone;
    }
  }

 private:
  template <class Rough>
  void simplifyRoughness(Rough& bsdf) const {
    (*this)(bsdf.alpha);
    if (!bsdf.alphaV) return;
    (*this)(*bsdf.alphaV);
    if (bsdf.alpha.texture == bsdf.alphaV->texture && bsdf.alpha.value == bsdf.alphaV->value) bsdf.alphaV.reset();
  }

  std::optional<Rgb> colourOf(uint32_t texture) const { return texture == kNone ? std::nullopt : colours_[texture]; }

  std::vector<std::optional<Rgb>> colours_;
};

// A blend of one BSDF with weight 1 is that BSDF, in the blend's own adapters. What both have adapters around stays.
void unwrapBlend(Material& material, const Scene& scene) {
  const auto* blend = std::get_if<Blend>(&material.kind);
  if (blend == nullptr || blend->weightTexture != kNone || blend->materials.size() != 1 || blend->weights[0] != 1) {
    return;
  }
  const Material& part = scene.materials[blend->materials[0]];
  const bool mapped = material.bumpTexture != kNone || material.normalTexture != kNone;
  if (part.opacity && material.opacity) return;
  if (mapped && (part.opacity || part.twoSided)) return;
  material.twoSided = material.twoSided || part.twoSided;
  if (part.opacity) material.opacity = part.opacity;
  const auto kind = part.kind;
  material.kind = kind;
}

}  // namespace

void simplifyScene(Scene& scene) {
  for (Shape& shape : scene.shapes) {
    Mesh* const mesh = std::get_if<Mesh>(&shape.kind);
    if (mesh != nullptr && !mesh->normals.empty() && isFlat(*mesh)) mesh->normals = {};
  }
  const Simplifier simplify(scene);
  // Parts of blends come before them.
  for (Material& material : scene.materials) {
    simplify(material);
    unwrapBlend(material, scene);
  }
  for (Emitter& emitter : scene.emitters) {
    if (auto* area = std::get_if<AreaEmitter>(&emitter.kind)) simplify(area->radiance);
    if (auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind)) simplify(projector->irradiance);
  }
}

}  // namespace wavecrest
