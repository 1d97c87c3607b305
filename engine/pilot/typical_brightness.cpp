#include "engine/pilot/typical_brightness.h"

#include <utility>
#include <vector>

#include "engine/pilot/median.h"
#include "engine/pilot/pilot_paths.h"

namespace wavecrest {

template <class S>
double typicalBrightness(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  constexpr size_t kPlaces = 32;  // the brightness of each need only be right within a factor of two or so
  constexpr size_t kPathsPerPlace = kPilotPaths / kPlaces;
  const std::vector<double> paths = tracePilotPaths(plan, settings, area, kPlaces, PilotLight::weighted);
  std::vector<double> places(kPlaces, 0);
  for (size_t i = 0; i < paths.size(); ++i) places[i / kPathsPerPlace] += paths[i] / kPathsPerPlace;
  std::erase(places, 0.0);
  return medianOf(std::move(places));
}
template double typicalBrightness(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template double typicalBrightness(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

template <class S>
S connectionRouletteLimit(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const bool applies = hasConnectionRoulette(settings.method) && plan.accel() != Accel::small;
  if (!applies || settings.connectionRoulette == 0) return 0;
  return static_cast<S>(settings.connectionRoulette * typicalBrightness(plan, settings, area));
}
template float connectionRouletteLimit(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template double connectionRouletteLimit(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
