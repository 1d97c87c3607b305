#include "metrics/hdrvdp2/resize.h"

#include <algorithm>
#include <cmath>

#include "metrics/planes/plane.h"

namespace wavecrest::vdp {
namespace {

double cubic(double t) {
  t = std::abs(t);
  if (t <= 1) return (1.5 * t - 2.5) * t * t + 1;
  if (t <= 2) return ((-0.5 * t + 2.5) * t - 4) * t + 2;
  return 0;
}

size_t mirrored(int64_t index, size_t length) {
  const auto period = static_cast<int64_t>(2 * length);
  const int64_t i = ((index % period) + period) % period;
  return static_cast<size_t>(i < period / 2 ? i : period - 1 - i);
}

}  // namespace

ResizeTable::ResizeTable(size_t inputs, size_t outputs) {
  const double scale = static_cast<double>(outputs) / static_cast<double>(inputs);
  const double narrowed = std::min(scale, 1.0), reach = 2 / narrowed;
  if (inputs == outputs) {
    taps = 1;
  } else {
    taps = static_cast<size_t>(std::floor(2 * reach)) + 1;
  }
  stride = roundUpToLanes(outputs);
  indexByOutput.assign(outputs * taps, 0);
  weightByOutput.assign(outputs * taps, 0);
  indexByTap.assign(stride * taps, 0);
  weightByTap.assign(stride * taps, 0);
  for (size_t i = 0; i < outputs; ++i) {
    const double centre = (static_cast<double>(i) + 0.5) / scale - 0.5;
    const auto first = inputs == outputs ? static_cast<int64_t>(i) : static_cast<int64_t>(std::ceil(centre - reach));
    for (size_t tap = 0; tap < taps; ++tap) {
      const int64_t j = first + static_cast<int64_t>(tap);
      const double weight = narrowed * cubic(narrowed * (static_cast<double>(j) - centre));
      const auto index = static_cast<uint32_t>(mirrored(j, inputs));
      indexByOutput[i * taps + tap] = indexByTap[tap * stride + i] = index;
      weightByOutput[i * taps + tap] = weightByTap[tap * stride + i] = static_cast<float>(weight);
    }
  }
}

}  // namespace wavecrest::vdp
