#include "bench/throughput/bench_scene.h"

#include "engine/plan/render_plan.h"

namespace wavecrest {
namespace {

// Parts of the time that each measurement gets.
constexpr double kReferencePart = 0.3, kErrorPart = 0.15, kSpeedPart = 0.2, kEmbreePart = 0.1, kPoliciesPart = 0.25;

}  // namespace

SceneBench::SceneBench(Scene scene, const RenderSettings& settings, const std::vector<Method>& methods, double seconds)
    : scene_(std::make_unique<const Scene>(std::move(scene))),
      settings_(settings),
      methods_(methods),
      seconds_(seconds) {
  for (const Method method : methods_) speeds_.emplace_back(*scene_, settingsOf(method));
}

RenderSettings SceneBench::settingsOf(Method method) const {
  RenderSettings settings = settings_;
  settings.method = method;
  return settings;
}

void SceneBench::visit() {
  constexpr double kVisits = kVisitsForInterval;
  for (SpeedMeasurement& speed : speeds_) speed.visit(kSpeedPart * seconds_ / kVisits);
}

SceneResult SceneBench::finish() const {
  const FilmArea area = filmArea(scene_->film);
  SceneResult result{.scene = scene_->name,
                     .hash = scene_->hash,
                     .width = area.width,
                     .height = area.height,
                     .threads = settings_.threads,
                     .reference = renderReference(*scene_, settings_, kReferencePart * seconds_),
                     .methods = {},
                     .errors = {}};
  const double errorSeconds = kErrorPart * seconds_ / static_cast<double>(kAllSamplerKinds.size());
  result.errors = measureEqualTime(*scene_, settings_, methods_, result.reference, errorSeconds);
  for (size_t i = 0; i < methods_.size(); ++i) {
    const RenderSettings own = settingsOf(methods_[i]);
    result.methods.push_back({.method = methods_[i],
                              .speed = speeds_[i].speed(),
                              .bareEmbree = measureBareEmbree(*scene_, own, kEmbreePart * seconds_),
                              .policies = measurePolicies(*scene_, own, kPoliciesPart * seconds_)});
  }
  return result;
}

// The last visits come with what is measured at the end, so that a scene's result is shown as soon as it is known.
void benchInTurn(std::vector<SceneBench>& benches, const std::function<void(const SceneResult&)>& done) {
  for (size_t visit = 1; visit < kVisitsForInterval; ++visit) {
    for (SceneBench& bench : benches) bench.visit();
  }
  for (SceneBench& bench : benches) {
    bench.visit();
    done(bench.finish());
  }
}

}  // namespace wavecrest
