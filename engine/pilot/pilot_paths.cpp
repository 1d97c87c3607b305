#include "engine/pilot/pilot_paths.h"

#include <algorithm>
#include <cmath>

#include "engine/pilot/repeated_pixels.h"
#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"

namespace wavecrest {

template <class S>
std::vector<double> tracePilotPaths(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                                    size_t places, PilotLight light) {
  const FlushToZero flushToZero;
  // Make the pass of path tracing, whatever the plan's method is.
  const Pass<S> pass =
      makePipeline(pageOf(Method::pt, {}), *plan.stages, chooseIntersector(*plan.stages, *plan.scene)).cameraPass();
  MisSettings strategies = pass.strategies;
  SceneView<S> view = plan.view;
  if (light != PilotLight::weighted) strategies.emission = strategies.nextEvent = false;  // nothing shares a path
  // Without lights in the list, next events add nothing.
  if (light == PilotLight::byChance) view.lightCount = 0;
  // Each place is a run of pixels in the order of waves, which is a small tile.
  const size_t pathsPerPlace = kPilotPaths / places;
  std::vector<uint32_t> pixels;
  for (size_t place = 0; place < places; ++place) {
    const size_t first = place * area.pixels.size() / places;
    for (size_t i = 0; i < pathsPerPlace; ++i) pixels.push_back(area.pixels[(first + i) % area.pixels.size()]);
  }
  // Paths of different pixels are in one wave. The complement of the seed gives random numbers that the render does not
  // use.
  StageCounters counters;
  std::vector<uint32_t> visited;
  StageContext<S> context{.scene = &view,
                          .pixels = nullptr,
                          .sampler = {SamplerKind::independent, ~settings.seed, 0},
                          .limits = settings.limits,
                          .mis = misSettings(strategies, plan.mergeRadius, 1, 0),
                          .film = area.window(),
                          .counters = &counters};
  Wave<S> wave(static_cast<uint32_t>(pixels.size()), plan.needs);
  std::vector<double> brightness(pixels.size(), 0);
  for (const std::vector<size_t>& visit : visitsOf(pixels)) {
    visited.clear();
    for (const size_t path : visit) visited.push_back(pixels[path]);
    context.pixels = visited.data();
    wave.pathCount = visited.size();
    runPass(pass, context, wave, nullptr);
    // Keep the brightest channel of each path.
    for (size_t i = 0; i < visit.size(); ++i) {
      const double value = std::max({wave.radiance.red[i], wave.radiance.green[i], wave.radiance.blue[i]});
      if (std::isfinite(value)) brightness[visit[i]] = value;
    }
    ++context.sampler.iteration;
  }
  return brightness;
}
template std::vector<double> tracePilotPaths(const RenderPlan<float>&, const RenderSettings&, const FilmArea&, size_t,
                                             PilotLight);
template std::vector<double> tracePilotPaths(const RenderPlan<double>&, const RenderSettings&, const FilmArea&, size_t,
                                             PilotLight);

}  // namespace wavecrest
