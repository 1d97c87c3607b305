#include "bench/throughput/bench_scene.h"

#include "engine/render_plan.h"

namespace wavecrest {
namespace {

// Parts of the time that each measurement gets.
constexpr double kReferencePart = 0.3, kErrorPart = 0.15, kSpeedPart = 0.2, kEmbreePart = 0.1, kPoliciesPart = 0.25;

}  // namespace

SceneResult benchScene(const Scene& scene, const RenderSettings& settings, const std::vector<Method>& methods,
                       double seconds) {
  const FilmArea area = filmArea(scene.film);
  SceneResult result{.scene = scene.name,
                     .hash = scene.hash,
                     .width = area.width,
                     .height = area.height,
                     .threads = settings.threads,
                     .reference = renderReference(scene, settings, kReferencePart * seconds),
                     .methods = {},
                     .errors = {}};
  const double errorSeconds = kErrorPart * seconds / static_cast<double>(kAllSamplerKinds.size());
  result.errors = measureEqualTime(scene, settings, methods, result.reference, errorSeconds);
  for (const Method method : methods) {
    RenderSettings own = settings;
    own.method = method;
    MethodResult& row = result.methods.emplace_back();
    row.method = method;
    row.speed = measureSpeed(scene, own, kSpeedPart * seconds);
    row.bareEmbree = measureBareEmbree(scene, own, kEmbreePart * seconds);
    row.policies = measurePolicies(scene, own, kPoliciesPart * seconds);
  }
  return result;
}

}  // namespace wavecrest
