#include "metrics/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wavecrest {
namespace {

void requireSameSize(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw std::invalid_argument("the halves of a reference differ in size");
}

}  // namespace

std::vector<NoiseFloor> noiseFloors(const Image& halfA, const Image& halfB, std::span<const Metric> metrics) {
  requireSameSize(halfA, halfB);
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

double unbiasedMeanSquareError(const Image& test, const Image& halfA, const Image& halfB) {
  requireSameSize(halfA, halfB);
  requireSameSize(test, halfA);
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < test.pixels.size(); ++i) {
    const double product = (double{test.pixels[i]} - halfA.pixels[i]) * (double{test.pixels[i]} - halfB.pixels[i]);
    if (!std::isfinite(product)) continue;
    sum += product;
    ++count;
  }
  return sum / static_cast<double>(count);
}

}  // namespace wavecrest
