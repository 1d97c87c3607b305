#include "engine/typical_brightness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/flush_to_zero.h"

namespace wavecrest {
namespace {

// Places on the film, and paths at each: enough of them to know a place's brightness within a factor of two or so.
constexpr size_t kPlaces = 32, kPathsPerPlace = 64;
constexpr size_t kWavePaths = 2 * kPathsPerPlace;

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
  std::vector<double> brightness(pixels.size());
  Wave<S> wave(kWavePaths, plan.needs);
  wave.pathCount = kWavePaths;
  for (wave.firstPath = 0; wave.firstPath < pixels.size(); wave.firstPath += kWavePaths) {
    ++context.sampler.iteration;  // a small film has the same pixels again
    runPass(pass, context, wave, nullptr);
    for (size_t i = 0; i < kWavePaths; ++i) {
      const double value = std::max({wave.radiance.red[i], wave.radiance.green[i], wave.radiance.blue[i]});
      brightness[wave.firstPath + i] = std::isfinite(value) ? value : 0;
    }
  }
  double roots = 0;
  for (size_t place = 0; place < kPlaces; ++place) {
    double sum = 0;
    for (size_t i = 0; i < kPathsPerPlace; ++i) sum += brightness[place * kPathsPerPlace + i];
    roots += std::sqrt(std::max(sum, 0.0) / kPathsPerPlace);
  }
  return (roots / kPlaces) * (roots / kPlaces);
}
template double typicalBrightness(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template double typicalBrightness(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
