#include "engine/waves/typical_brightness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/tasks/flush_to_zero.h"

namespace wavecrest {
namespace {

// Places on the film, and paths at each. The brightness of a place need only be right within a factor of two or so.
constexpr size_t kPlaces = 32, kPathsPerPlace = 64;

}  // namespace

template <class S>
double typicalBrightness(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  const FlushToZero flushToZero;
  const Pass<S> pass =
      makePipeline(pageOf(Method::pt, {}), *plan.stages, chooseIntersector(*plan.stages, *plan.scene)).cameraPass;
  // Each place is a run of pixels in the order of waves, which is a small tile.
  std::vector<uint32_t> pixels;
  for (size_t place = 0; place < kPlaces; ++place) {
    const size_t first = place * area.pixels.size() / kPlaces;
    for (size_t i = 0; i < kPathsPerPlace; ++i) pixels.push_back(area.pixels[(first + i) % area.pixels.size()]);
  }
  StageCounters counters;
  StageContext<S> context{.scene = &plan.scene->view,
                          .pixels = pixels.data(),
                          .sampler = {SamplerKind::independent, ~settings.seed, 0},
                          .limits = settings.limits,
                          .mis = misSettings(pass.strategies, settings, plan.scene->view.radius, 1, 0),
                          .film = area.window(),
                          .counters = &counters};
  Wave<S> wave(static_cast<uint32_t>(pixels.size()), plan.needs);
  wave.pathCount = pixels.size();
  runPass(pass, context, wave, nullptr);
  std::vector<double> places;  // where there is light
  for (size_t place = 0; place < kPlaces; ++place) {
    double sum = 0;
    for (size_t i = place * kPathsPerPlace; i < (place + 1) * kPathsPerPlace; ++i) {
      const double value = std::max({wave.radiance.red[i], wave.radiance.green[i], wave.radiance.blue[i]});
      if (std::isfinite(value)) sum += value;
    }
    if (sum > 0) places.push_back(sum / kPathsPerPlace);
  }
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
