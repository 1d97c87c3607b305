// Boxes and spheres around geometry.
#pragma once

#include <cstddef>
#include <limits>

#include "engine/scene/scene.h"
#include "kernels/extend/leaves.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// A box with its centre. The radius is half its diagonal times 1.0001, so that nothing on a corner is outside.
struct BoundingSphere {
  double center[3]{}, radius = 0;
  double low[3]{}, high[3]{};  // corners of the box

  // Half edge of a box around all primitives which touches none, so that rays which start on it meet what lies along
  // its faces.
  double halfExtent(size_t axis) const {
    constexpr double kClearance = 1e-4;  // relative to the radius: some hundred times the rounding of a position
    return (high[axis] - low[axis]) / 2 + kClearance * radius;
  }
};

// The box around what was included; empty at first, with low above high.
struct Extent {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Double3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void include(const Double3& p);
  void include(const Extent& other);
  template <class S>
  void include(const PrimitiveRecord<S>& record);
  BoundingSphere sphere() const;
};

// Rounded outwards.
Box boxOf(const Extent& extent);

template <class S>
Extent extentOf(const PrimitiveRecord<S>& record) {
  Extent extent;
  extent.include(record);
  return extent;
}

// Where kernels have their origin, so that float resolves a scene that is far from its own: on each axis 0, or the
// centre of the box if that is farther away than eight radii of the scene. Nearer scenes lose three bits of 24 at most
// and keep the coordinates they were written in. Centres are rounded to float, which takes nothing from the vertices of
// meshes: their difference from it is exact, and what met in a corner still does.
Double3 originOf(const BoundingSphere& bounds);

}  // namespace wavecrest
