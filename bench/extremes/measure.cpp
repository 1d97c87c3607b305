#include "bench/extremes/measure.h"

#include <cmath>
#include <numeric>

#include "bench/statistics/bands.h"

namespace wavecrest {

SeedValues measureSeeds(const Scene& scene, RenderSettings settings, uint64_t samples, size_t seeds) {
  SeedValues out;
  for (size_t seed = 0; seed < seeds; ++seed) {
    settings.seed = 7000 + seed;
    const auto session = Session::create(scene, settings);
    session->renderUntil(samples, std::nullopt);
    const std::vector<float> image = session->film().resolve();
    const double sum = std::accumulate(image.begin(), image.end(), 0.0);
    out.means.push_back(sum / static_cast<double>(image.size()));
    const StageCounters counters = session->statistics().counters;
    out.losses.nonFinite += counters.nonFinite;
    out.losses.closePairs += counters.closePairs;
    out.losses.cutPaths += counters.cutPaths;
  }
  return out;
}

SeedEstimate seedEstimateOf(const std::vector<double>& values) {
  const MeanEstimate estimate = meanOf(values);
  return {estimate.mean, std::sqrt(estimate.variance)};
}

std::vector<double> differences(const SeedValues& a, double scale, const SeedValues& b) {
  std::vector<double> out;
  for (size_t i = 0; i < a.means.size(); ++i) out.push_back(a.means[i] / scale - b.means[i]);
  return out;
}

}  // namespace wavecrest
