#include "engine/load/simplify.h"

#include <algorithm>
#include <optional>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// ---- meshes ---------------------------------------------------------------------------------------------------------

// Whether each vertex normal is that of all faces around the vertex.
bool isFlat(const Mesh& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<uint32_t, 3>& corners) {
    const Double3 p0 = widened(mesh.positions[corners[0]]);
    const Double3 across = cross(widened(mesh.positions[corners[1]]) - p0, widened(mesh.positions[corners[2]]) - p0);
    const double area2 = dot(across, across);
    if (!(area2 > 0)) return true;  // cannot be hit
    return std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) {
      // The sine, as rounding a normal to float changes its length, and with it the cosine, by more than kFlatSine2.
      const Double3 normal = widened(mesh.normals[corner]), sine = cross(normal, across);
      return dot(normal, across) > 0 && dot(sine, sine) <= kFlatSine2 * dot(normal, normal) * area2;
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
  // Compare each pixel with the first one.
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

// Whether a surface is diffuse and takes all light that arrives.
bool isBlack(const Material& material) {
  const auto* diffuse = std::get_if<Diffuse>(&material.kind);
  return diffuse != nullptr && diffuse->reflectance.texture == kNone && diffuse->reflectance.value == Rgb{0, 0, 0} &&
         !material.opacity;
}

// Whether light may go straight on through a part: a mask, or a boundary that may be between equal indices.
bool mayPass(const Material& material) {
  return material.opacity.has_value() || std::holds_alternative<Dielectric>(material.kind);
}

// Replaces textures of one colour by that colour, with a function for each kind of value and each kind of BSDF.
class Simplifier {
 public:
  explicit Simplifier(const Scene& scene) : scene_(scene) {
    for (const Texture& texture : scene.textures) colours_.push_back(onlyColour(texture));
  }

  void operator()(TexturedRgb& value) const {
    if (const auto colour = colourOf(value.texture)) value = {*colour, kNone};
  }
  // Only a grey colour is replaced: the texture kernel decides how any other becomes a number.
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
  // A weight texture of one value becomes two constant weights. Parts of weight 0 are removed, then black ones, but one
  // part stays. The weights of the others stay as they are: what they lack of 1 together is absorbed. Beside a part
  // that light passes, black stays: what is absorbed without it would tint that light (METHODS 3.10).
  void operator()(Blend& blend) const {
    if (blend.weightTexture != kNone) {
      TexturedFloat weight{0, blend.weightTexture};
      (*this)(weight);
      if (weight.texture != kNone) return;
      const double second = std::clamp(weight.value, 0.0, 1.0);
      blend.weightTexture = kNone;
      blend.weights = {1 - second, second};
    }
    const auto remove = [&blend](const auto& isNone) {
      for (size_t i = blend.materials.size(); i-- > 0 && blend.materials.size() > 1;) {
        if (!isNone(i)) continue;
        blend.materials.erase(blend.materials.begin() + static_cast<ptrdiff_t>(i));
        blend.weights.erase(blend.weights.begin() + static_cast<ptrdiff_t>(i));
      }
    };
    remove([&](size_t i) { return blend.weights[i] == 0; });
    if (std::ranges::any_of(blend.materials, [&](uint32_t part) { return mayPass(scene_.materials[part]); })) return;
    remove([&](size_t i) { return isBlack(scene_.materials[blend.materials[i]]); });
  }
  // Any other kind of BSDF stays as it is.
  template <class Kind>
  void operator()(Kind&) const {}

  // The BSDF, and the adapters around it.
  void operator()(Material& material) const {
    std::visit([this](auto& kind) { (*this)(kind); }, material.kind);
    if (material.opacity) {
      (*this)(*material.opacity);
      if (material.opacity->texture == kNone && material.opacity->value >= 1) material.opacity.reset();
    }
    // A bump map of one height has no slope, and (0.5, 0.5, 1) encodes the unchanged normal.
    if (colourOf(material.bumpTexture)) material.bumpTexture = kNone;
    if (const auto normal = colourOf(material.normalTexture)) {
      if (*normal == Rgb{0.5, 0.5, 1}) material.normalTexture = kNone;
    }
  }

 private:
  // Two roughnesses that are equal after their simplification make the BSDF isotropic.
  template <class Rough>
  void simplifyRoughness(Rough& bsdf) const {
    (*this)(bsdf.alpha);
    if (!bsdf.alphaV) return;
    (*this)(*bsdf.alphaV);
    if (bsdf.alpha.texture == bsdf.alphaV->texture && bsdf.alpha.value == bsdf.alphaV->value) bsdf.alphaV.reset();
  }

  std::optional<Rgb> colourOf(uint32_t texture) const { return texture == kNone ? std::nullopt : colours_[texture]; }

  const Scene& scene_;
  std::vector<std::optional<Rgb>> colours_;
};

// A blend of one BSDF with weight 1 becomes that BSDF, in the adapters of both. It stays a blend if one material cannot
// have the adapters of both.
void unwrapBlend(Material& material, const Scene& scene) {
  const auto* blend = std::get_if<Blend>(&material.kind);
  if (blend == nullptr || blend->weightTexture != kNone || blend->materials.size() != 1 || blend->weights[0] != 1) {
    return;
  }
  const Material& part = scene.materials[blend->materials[0]];
  if (part.opacity && material.opacity) return;
  if (material.hasMap() && (part.opacity || part.twoSided)) return;
  material.twoSided = material.twoSided || part.twoSided;
  if (part.opacity) material.opacity = part.opacity;
  const auto kind = part.kind;
  material.kind = kind;
}

}  // namespace

void simplifyScene(Scene& scene) {
  // Faceted meshes need no normals.
  for (Shape& shape : scene.shapes) {
    Mesh* const mesh = std::get_if<Mesh>(&shape.kind);
    if (mesh != nullptr && !mesh->normals.empty() && isFlat(*mesh)) mesh->normals = {};
  }
  // Materials.
  const Simplifier simplify(scene);
  // The parts of a blend have lower indices, so they are simplified before it.
  for (Material& material : scene.materials) {
    simplify(material);
    unwrapBlend(material, scene);
  }
  // Lights.
  for (Emitter& emitter : scene.emitters) {
    if (auto* area = std::get_if<AreaEmitter>(&emitter.kind)) simplify(area->radiance);
    if (auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind)) simplify(projector->irradiance);
  }
}

}  // namespace wavecrest
