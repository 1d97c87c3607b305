#include "engine/pilot/light_walks.h"

#include <algorithm>
#include <cmath>

#include "engine/plan/survival.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

template <class S>
LightPilot walkLightPaths(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const FlushToZero flushToZero;
  const size_t lightPaths = lightPathsWanted(settings, area.size());
  // A wave, a light store and a context, as a worker has them.
  Wave<S> wave(settings.waveSize, plan.needs);
  LightStore<S> store(settings.waveSize, plan.needs, plan.lightUse);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &plan.view;
  context.sampler = samplerOf(settings, 0, lightPaths);
  context.limits = settings.limits;
  const std::optional<SurvivalRule> rule = survivalRule(settings, Walk::light);
  context.survival = pointerTo(rule);
  context.mis = misSettings(plan.pipeline.lightPass()->strategies, plan.mergeRadius, lightPaths, 0);
  context.light.store = &store;
  context.film = area.window();
  context.counters = &counters;
  LightPilot pilot;
  // The drain counts splats by the exponent of their largest channel.
  const SplatDrain<S> drain = [&](Splats<S>& splats) {
    for (size_t i = 0; i < splats.size; ++i) {
      const auto value = static_cast<double>(std::max({splats.red[i], splats.green[i], splats.blue[i]}));
      if (!(value > 0 && std::isfinite(value))) continue;
      ++pilot.splats;
      pilot.exponents += std::ilogb(value);
    }
    splats.size = 0;
  };
  // Walk one wave after the other. All waves use the same store. The number of paths does not depend on the size of
  // waves: the unit of splats follows from these paths, and with it the last bits of an image.
  const size_t wanted = std::min(kPilotLightPaths, lightPaths);
  while (pilot.paths < wanted) {
    wave.firstPath = pilot.paths;
    wave.pathCount = std::min<size_t>(settings.waveSize, wanted - pilot.paths);
    runPass<S>(*plan.pipeline.lightPass(), context, wave, nullptr, drain);
    pilot.paths += wave.pathCount;
    pilot.stored += store.vertices.size;
    for (size_t i = 0; plan.pipeline.has(Fold::photonMap) && i < store.vertices.size; ++i) {
      const S* const place = store.vertices.row[i].position;
      pilot.photons.push_back(
          {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])});
    }
    pilot.room = std::max(pilot.room, store.roomUsed());
  }
  return pilot;
}
template LightPilot walkLightPaths(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template LightPilot walkLightPaths(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
