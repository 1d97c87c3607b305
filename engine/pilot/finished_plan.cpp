#include "engine/pilot/finished_plan.h"

#include <utility>

#include "engine/pilot/light_picks.h"
#include "engine/pilot/light_walks.h"
#include "engine/pilot/merge_radius.h"
#include "engine/pilot/typical_brightness.h"
#include "engine/pilot/walk_balance.h"

namespace wavecrest {
namespace {

// Plans memory and the radius of merges. Walks light paths where their number of vertices matters.
template <class S>
void planLightPaths(RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const bool walks = plan.pipeline.lightPass() != nullptr && !plan.pipeline.chains;
  plan.memory = planMemory(plan, settings, area, walks ? walkLightPaths(plan, settings, area) : LightPilot{});
  plan.memory.lightPaths *= lightWalksPerCameraWalk(plan, settings, area);
  if (plan.pipeline.has(Fold::photonMap)) plan.mergeRadius = chosenRadius(plan, settings, area);
}

template <class S>
DryPlan dryPlan(RenderPlan<S> plan, const RenderSettings& settings, const FilmArea& area) {
  planLightPaths(plan, settings, area);
  const bool merges = plan.pipeline.has(Fold::photonMap) && !isChosenByTrials(settings.method);
  return {.method = settings.method,
          .memory = plan.memory,
          .mergeRadius = merges ? std::optional(plan.mergeRadius) : std::nullopt,
          .specialization = plan.specialization,
          .isa = plan.isa,
          .accel = plan.accel(),
          .spreads = spreadsSamples(plan, settings)};
}

DryPlan dryPlanOf(const Scene& scene, const RenderSettings& settings) {
  const RenderSettings limited = withinDepthOfMethod(settings);
  const FilmArea area = filmOutline(scene.film);
  const RenderSettings cut = withPieces(limited, scene.film, area.size());
  return settings.precision == Precision::doubled ? dryPlan(planRender<double>(scene, cut), cut, area)
                                                  : dryPlan(planRender<float>(scene, cut), cut, area);
}

}  // namespace

template <class S>
RenderPlan<S> finishedPlan(const Scene& scene, const RenderSettings& settings, const FilmArea& area,
                           std::shared_ptr<const CompiledScene<S>> compiled) {
  RenderPlan<S> plan = planRender<S>(scene, settings, std::move(compiled));
  planLightPaths(plan, settings, area);
  // Path tracing picks its lights by what they give in view (METHODS 2.3).
  if (!plan.pipeline.lightPass() && !plan.pipeline.chains) pickLightsByView(plan, settings, area);
  if (!plan.pipeline.lessons.empty()) plan.typicalBrightness = typicalBrightness(plan, settings, area);
  plan.connectionRouletteBelow = connectionRouletteLimit(plan, settings, area);
  return plan;
}
template RenderPlan<float> finishedPlan(const Scene&, const RenderSettings&, const FilmArea&,
                                        std::shared_ptr<const CompiledScene<float>>);
template RenderPlan<double> finishedPlan(const Scene&, const RenderSettings&, const FilmArea&,
                                         std::shared_ptr<const CompiledScene<double>>);

DryPlan planWithoutSession(const Scene& scene, const RenderSettings& settings) {
  try {
    return dryPlanOf(scene, settings);
  } catch (const MemoryBudgetError&) {
    if (!areTried(settings)) throw;
  }
  // Trials may choose path tracing, which needs the least memory.
  RenderSettings least = settings;
  least.method = Method::pt;
  least.lightPaths.reset();
  return dryPlanOf(scene, least);
}

MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings) {
  return planWithoutSession(scene, settings).memory;
}

}  // namespace wavecrest
