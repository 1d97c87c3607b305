// The radius of merges, by iterations (METHODS 6.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace wavecrest {

// Of the largest coordinate. Positions have 24 bits: of a smaller radius nothing would be left but their rounding.
constexpr double kSmallestRadius = 16 * 0x1p-24;

struct MergeRadius {
  double first = 0;                // of iteration 0, relative to the scene's
  double alpha = 1;                // how fast it shrinks
  double scene = 1;                // the radius of the scene's bounding sphere
  double least = kSmallestRadius;  // relative to the scene's: more where it is far from its origin
  // Where a camera path typically merges first, as a pilot saw it: the side of a pixel, and how many photons of an
  // iteration are on a unit of area. 0: nowhere.
  double pixel = 0, photonsPerArea = 0;

  // In units of the scene. Iterations count from zero, those of METHODS 6.1 from one.
  double at(uint64_t iteration) const {
    const double shrink = std::pow(static_cast<double>(iteration + 1), (alpha - 1) / 2);
    return std::max(first * shrink, least) * scene;
  }
  // Of the first iteration.
  double inPixels() const { return pixel > 0 ? at(0) / pixel : 0; }
  double photonsPerSearch() const { return std::numbers::pi * at(0) * at(0) * photonsPerArea; }
};

}  // namespace wavecrest
