#include "bench/campaign/reference_method.h"

#include <algorithm>
#include <variant>

namespace wavecrest {
namespace {

bool isSpecular(const Material& material) {
  if (const auto* conductor = std::get_if<Conductor>(&material.kind)) {
    return conductor->alpha.texture == kNone && conductor->alpha.value == 0;
  }
  if (const auto* dielectric = std::get_if<Dielectric>(&material.kind)) {
    return dielectric->alpha.texture == kNone && dielectric->alpha.value == 0;
  }
  return false;
}

bool isDelta(const Emitter& emitter) {
  return std::holds_alternative<PointEmitter>(emitter.kind) || std::holds_alternative<SpotEmitter>(emitter.kind) ||
         std::holds_alternative<DirectionalEmitter>(emitter.kind);
}

}  // namespace

ReferenceMethod referenceMethod(const Scene& scene) {
  const bool specular = std::any_of(scene.materials.begin(), scene.materials.end(), isSpecular);
  const bool delta = std::any_of(scene.emitters.begin(), scene.emitters.end(), isDelta);
  if (!specular) return {Method::pt, "path tracing samples every path: no surface is specular"};
  if (!delta) return {Method::bpt, "specular surfaces throw light that path tracing meets by chance only"};
  return {Method::vcm, "lights without extent behind specular surfaces: only merging meets such paths; biased"};
}

}  // namespace wavecrest
