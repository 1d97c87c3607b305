#include "engine/pilot/finished_plan.h"

#include "engine/pilot/light_picks.h"
#include "engine/pilot/light_walks.h"
#include "engine/pilot/typical_brightness.h"

namespace wavecrest {
namespace {

// The memory of a plan. Walks light paths where their number of vertices matters.
template <class S>
MemoryPlan memoryOf(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const bool walks = plan.pipeline.lightPass() && !plan.pipeline.chains;
  return planMemory(plan, settings, area, walks ? walkLightPaths(plan, settings, area) : LightPilot{});
}

}  // namespace

template <class S>
RenderPlan<S> finishedPlan(const Scene& scene, const RenderSettings& settings, const FilmArea& area) {
  RenderPlan<S> plan = planRender<S>(scene, settings);
  plan.memory = memoryOf(plan, settings, area);
  // Path tracing picks its lights by what they give in view (METHODS 2.3).
  if (!plan.pipeline.lightPass() && !plan.pipeline.chains) pickLightsByView(plan, settings, area);
  plan.connectionRouletteBelow = connectionRouletteLimit(plan, settings, area);
  return plan;
}
template RenderPlan<float> finishedPlan(const Scene&, const RenderSettings&, const FilmArea&);
template RenderPlan<double> finishedPlan(const Scene&, const RenderSettings&, const FilmArea&);

MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings) {
  const RenderSettings limited = withinDepthOfMethod(settings);
  const FilmArea area = filmArea(scene.film);
  const RenderSettings cut = withPieces(limited, scene.film, area.pixels.size());
  return settings.precision == Precision::doubled ? memoryOf(planRender<double>(scene, cut), cut, area)
                                                  : memoryOf(planRender<float>(scene, cut), cut, area);
}

}  // namespace wavecrest
