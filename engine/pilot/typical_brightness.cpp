#include "engine/pilot/typical_brightness.h"

#include <algorithm>
#include <vector>

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
  if (places.empty()) return 0;
  const auto median = places.begin() + static_cast<ptrdiff_t>(places.size() / 2);
  std::nth_element(places.begin(), median, places.end());
  return *median;
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
