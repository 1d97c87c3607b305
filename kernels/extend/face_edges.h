// The edges of a small scene's faces, and what roundings of corners count as none: what findBoxes and findSolids share.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/double_vectors.h"
#include "kernels/extend/offset.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// Edges and centres that differ by this many roundings of the largest coordinate count as one: four corners, each
// rounded to float, stand behind the last of a box's eight.
constexpr double kSameCorner = 4 * kUnitRoundoff;
// How far a corner may lie off the plane of its face, relative to |normal| . |corner|. Rays start from the quad and are
// tested against the box, so this counts against kOffsetGamma, to which other roundings contribute 12 units.
constexpr double kFlatness = 2 * kUnitRoundoff;
constexpr double kDoubleError = 0x1p-48;  // of this computation

inline double largest(const D3& a) { return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])}); }
// How far off the plane of its face a corner may be.
inline double flatnessAt(const D3& normal, const D3& corner) {
  return kFlatness * absDot(normal, corner) + kDoubleError * largest(corner);
}

struct Edge {
  D3 from, along;
};
inline double distanceTo(const Edge& edge, const D3& point) {
  const double share = dot(point - edge.from, edge.along) / dot(edge.along, edge.along);
  return length(point - edge.from - edge.along * std::clamp(share, 0.0, 1.0));
}
// Whether a part of one lies on the other; crossing it is not enough.
inline bool overlap(const Edge& a, const Edge& b, double tolerance) {
  return distanceTo(a, b.from) <= tolerance || distanceTo(a, b.from + b.along) <= tolerance ||
         distanceTo(b, a.from) <= tolerance || distanceTo(b, a.from + a.along) <= tolerance;
}
inline std::vector<Edge> edgesOf(const PrimitiveRecord<double>& face) {
  const D3 p0 = vec(face.p0), e1 = vec(face.e1), e2 = vec(face.e2);
  if (static_cast<PrimitiveKind>(face.kind) == PrimitiveKind::triangle) return {{p0, e1}, {p0, e2}, {p0 + e1, e2 - e1}};
  return {{p0, e1}, {p0, e2}, {p0 + e1, e2}, {p0 + e2, e1}};
}
inline bool anyOverlap(const std::vector<Edge>& edges, const std::vector<Edge>& others, double tolerance) {
  for (const Edge& edge : edges) {
    for (const Edge& other : others) {
      if (overlap(edge, other, tolerance)) return true;
    }
  }
  return false;
}

}  // namespace wavecrest
