// Shapes to primitive records: the scene's geometry as the kernels see it.
#pragma once

#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

struct PrimitiveCounts {
  uint32_t quads = 0, triangles = 0, spheres = 0;
  uint32_t total() const { return quads + triangles + spheres; }
};

template <class S>
struct Primitives {
  std::vector<PrimitiveRecord<S>> records;  // quads, then triangles, then spheres
  std::vector<AttributeRecord> attributes;
  PrimitiveCounts counts;
  std::vector<uint32_t> shapeOf;  // of each record whose shape emits light, else kNone; empty if no shape does
};

// Rectangles become quads, meshes triangles, and coplanar triangle pairs of small meshes that form a parallelogram
// (each face of a cube) become quads again. Records are computed in double and rounded once to S.
// Attributes are kept where shading needs them: for smooth meshes, and for all that may be textured if `textured`.
// Positions are relative to `origin`.
template <class S>
Primitives<S> compilePrimitives(const Scene& scene, bool textured, const Double3& origin = {});

// Bounding sphere of all primitives: centre and half diagonal of the bounding box, times 1.0001.
struct BoundingSphere {
  double center[3]{}, radius = 0;
  double low[3]{}, high[3]{};  // corners of the box
};
template <class S>
BoundingSphere boundPrimitives(std::span<const PrimitiveRecord<S>> records);
template <class S>
BoundingSphere boundPrimitives(const std::vector<PrimitiveRecord<S>>& records) {
  return boundPrimitives(std::span<const PrimitiveRecord<S>>(records));
}

// Where kernels have their origin, so that float resolves a scene that is far from its own: on each axis 0, or the
// centre of the box if that is farther away than eight radii of the scene. Nearer scenes lose three bits of 24 at most
// and keep the coordinates they were written in. Centres are rounded to float, which takes nothing from the vertices of
// meshes: their difference from it is exact, and what met in a corner still does.
Double3 originOf(const BoundingSphere& bounds);

}  // namespace wavecrest
