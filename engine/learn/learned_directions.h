// What a render has learned about the directions of paths at one place, for people to look at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/columns/guide_view.h"

namespace wavecrest {

struct LearnedDirections {
  uint32_t cell = 0;       // of the place
  size_t cells = 0;        // that the scene is divided into
  double guidedShare = 0;  // of directions that the guide draws there; 0: it has no histogram yet
  std::array<float, kGuideBins>
      squareDensity{};  // of each bin, per area of the square [-1,1]^2 (kernels/columns/guide_view.h)

  // Of a unit direction in world space, what the guide draws per steradian; 0 without a histogram.
  double density(const std::array<double, 3>& direction) const;
};

}  // namespace wavecrest
