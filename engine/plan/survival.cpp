#include "engine/plan/survival.h"

namespace wavecrest {
namespace {

// What throughput is multiplied by where efficiency decides: by throughput alone paths end too early where they bring
// most of the light late, as in rooms that are lit through doors. Constants of each method, measured on nine scenes
// (engine/methods/METHODS.md, 1.5). Walks whose vertices are all joined with others are dear: none gains by longer
// ones.
float efficientScale(Method method, Walk walk) {
  if (method == Method::lt) return walk == Walk::light ? 2 : 4;
  return method == Method::pt || method == Method::gpt ? 4 : 1;
}

}  // namespace

std::optional<SurvivalRule> survivalRule(const RenderSettings& settings, Walk walk) {
  if (settings.roulette == Roulette::albedo) return SurvivalRule{.byAlbedo = true};
  if (settings.roulette == Roulette::throughput) return std::nullopt;
  // A guide leads paths that are dark so far to light.
  if (mayLearn(settings)) return SurvivalRule{.byAlbedo = true};
  return SurvivalRule{.scale = efficientScale(settings.method, walk)};
}

}  // namespace wavecrest
