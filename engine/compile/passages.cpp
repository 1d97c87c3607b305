#include "engine/compile/passages.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "engine/compile/materials.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

PassageRecord compilePassage(const Material& material, bool passes) {
  PassageRecord record{.opacity = 1, .opacityTexture = kNone, .tint = {1, 1, 1}, .tintTexture = kNone, .matched = 0};
  if (!passes) return record;
  if (material.opacity) {
    record.opacityTexture = material.opacity->texture;
    if (record.opacityTexture == kNone) {
      record.opacity = std::clamp(static_cast<float>(material.opacity->value), 0.0f, 1.0f);
    }
  }
  if (isIndexMatched(material)) {
    const TexturedRgb& tint = std::get<Dielectric>(material.kind).specularTransmittance;
    record.matched = 1;
    record.tintTexture = tint.texture;
    if (tint.texture == kNone) assign(record.tint, tint.value);
  }
  return record;
}

// Whether a shape that shines, or one that does not, is of one of these materials.
bool anyShape(const Scene& scene, const std::vector<bool>& materials, bool shining) {
  return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
    return shape.material != kNone && (shape.emitter != kNone) == shining && materials[shape.material];
  });
}

}  // namespace

bool hasPassage(const Material& material, const Scene& scene) {
  if (material.opacity || isIndexMatched(material)) return true;
  const auto* blend = std::get_if<Blend>(&material.kind);
  return blend != nullptr &&
         std::ranges::any_of(blend->materials, [&](uint32_t part) { return hasPassage(scene.materials[part], scene); });
}

bool tintsPassage(const Material& material, const Scene& scene) {
  if (const auto* blend = std::get_if<Blend>(&material.kind)) {
    // Of weights that do not add up to 1 the rest is absorbed.
    const double sum = std::accumulate(blend->weights.begin(), blend->weights.end(), 0.0);
    return (blend->weightTexture == kNone && std::abs(sum - 1) > 1e-6) ||
           std::ranges::any_of(blend->materials,
                               [&](uint32_t part) { return tintsPassage(scene.materials[part], scene); });
  }
  if (!isIndexMatched(material)) return false;
  const TexturedRgb& tint = std::get<Dielectric>(material.kind).specularTransmittance;
  return tint.texture != kNone || tint.value != Rgb{1, 1, 1};
}

CompiledMaterials compileMaterials(const Scene& scene, bool compounds) {
  std::vector<bool> passes;
  for (const Material& material : scene.materials) passes.push_back(hasPassage(material, scene));
  if (!anyShape(scene, passes, false)) passes.assign(passes.size(), false);
  const bool any = std::ranges::find(passes, true) != passes.end(), twice = any && anyShape(scene, passes, true);
  const auto count = static_cast<uint32_t>(scene.materials.size());
  if (size_t{count} * (twice ? 2 : 1) > kMaxMaterials) {
    throw SceneError(SourceLocation{scene.name}, "more than " + std::to_string(kMaxMaterials) + " materials");
  }
  CompiledMaterials out;
  out.withoutPassages = twice ? count : 0;
  for (const bool plain : {false, true}) {
    if (plain && !twice) break;
    for (uint32_t i = 0; i < count; ++i) {
      const bool through = passes[i] && !plain;
      const Material& material = scene.materials[i];
      out.records.push_back(compileMaterial(material, scene, through));
      if (any) out.passages.push_back(compilePassage(material, through));
      if (!compounds) continue;
      CompoundRecord& compound = out.compounds.emplace_back(compileCompound(material));
      if (plain) {
        for (uint32_t k = 0; k < compound.partCount; ++k) compound.part[k] += count;
      }
    }
  }
  return out;
}

}  // namespace wavecrest
