#include "metrics/noise_floor.h"

#include <algorithm>
#include <stdexcept>

namespace wavecrest {

std::vector<NoiseFloor> noiseFloors(const Image& halfA, const Image& halfB, std::span<const Metric> metrics) {
  if (halfA.width != halfB.width || halfA.height != halfB.height || halfA.channels != halfB.channels)
    throw std::invalid_argument("the halves of a reference differ in size");
  Image mean = halfA;
  for (size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = 0.5f * (halfA.pixels[i] + halfB.pixels[i]);
  const PreparedReference reference("mean of both halves", {std::move(mean), Encoding::linear, {}});
  const ComparedImage a = reference.prepareTest("first half", {halfA, Encoding::linear, {}});
  const ComparedImage b = reference.prepareTest("second half", {halfB, Encoding::linear, {}});
  std::vector<NoiseFloor> floors;
  for (const Metric& metric : metrics) {
    if (std::min(halfA.width, halfA.height) < metric.smallestSide) continue;
    const double first = mainScore(metric, metric.measure(reference, a, false));
    const double second = mainScore(metric, metric.measure(reference, b, false));
    floors.push_back({metric.name, 0.5 * (first + second)});
  }
  return floors;
}

}  // namespace wavecrest
