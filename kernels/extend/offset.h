// The bound on rounding that keeps rays from meeting the surface they start on.
//
// gamma(n) = n u / (1 - n u), u the unit roundoff of float, in which rays are traced under every precision policy
// (Pharr, Jakob, Humphreys, "Physically Based Rendering", 3.9.4).
#pragma once

#include <algorithm>

namespace wavecrest {

constexpr double kUnitRoundoff = 0x1p-24;
// 7 roundings in p0 + u e1 + v e2, 5 in the plane equation at either end, and margin for a unit normal that is not.
constexpr double kOffsetGamma = 16 * kUnitRoundoff;
// Relative to the length of a shadow ray: how much farther its end is moved off the surface there, along the normal.
// The ray starts far from that surface, and its intersection with the plane rounds by its length: 2 roundings in the
// segment, 4 in the distance of the origin to the plane, 3 in the speed towards it, 5 in their quotient. Spheres have
// as many.
constexpr double kEndGamma = 16 * kUnitRoundoff;

// Hits are moved this far (relative to the edge) inside their quad or triangle. Rounding then cannot put a path's
// vertex beyond a neighbouring wall, from where it would leave a closed scene.
constexpr float kInset = 0x1p-18f;

// The scalar twin of insideEdges in inset_lanes.h.
inline void moveInsideEdges(float& u, float& v, bool triangle) {
  u = std::clamp(u, kInset, 1 - kInset);
  v = std::clamp(v, kInset, 1 - kInset);
  const float scale = triangle ? std::min(1.0f, (1 - kInset) / (u + v)) : 1.0f;
  u *= scale;
  v *= scale;
}

}  // namespace wavecrest
