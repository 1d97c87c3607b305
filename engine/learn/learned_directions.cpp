#include "engine/learn/learned_directions.h"

#include <algorithm>
#include <cmath>

namespace wavecrest {

double LearnedDirections::density(const std::array<double, 3>& direction) const {
  // As kernels/guide/square_lanes.h.
  const double norm = std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]);
  double u = direction[0] / norm, v = direction[1] / norm;
  if (direction[2] < 0) {
    const double foldedU = std::copysign(1 - std::abs(v), u);
    v = std::copysign(1 - std::abs(u), v);
    u = foldedU;
  }
  const auto bin = [](double a) {
    return static_cast<size_t>(std::clamp((a + 1) / 2 * kGuideSide, 0.0, kGuideSide - 1.0));
  };
  return double{squareDensity[bin(v) * kGuideSide + bin(u)]} / (norm * norm * norm);
}

}  // namespace wavecrest
