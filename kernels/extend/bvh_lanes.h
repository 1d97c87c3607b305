// Tests of rays against leaves: one ray against the slots of a leaf, or a block of rays against one slot at a time.
// Number: FloatGroup or Float.
//
// Watertight, and no wider than the triangles are: corners are laid into a plane across the ray, where every triangle
// that has a corner finds it in the same place, and edge functions there have the right sign or are 0 (Woop, Benthin,
// Wald, "Watertight Ray/Triangle Intersection", JCGT 2013). A ray at 0 is inside both neighbours of the edge.
#pragma once

#include "kernels/extend/bvh.h"
#include "kernels/extend/sphere_lanes.h"
#include "kernels/simd/group.h"
#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

// Axes in the order in which rays see corners: the last is that of the direction's greatest part.
struct RayAxes {
  uint32_t axis[3];
};
constexpr RayAxes kAxesAlong[3] = {{{1, 2, 0}}, {{2, 0, 1}}, {{0, 1, 2}}};

// The point in the ray's frame: x and y across the ray, z along the greatest part of its direction. p: relative to the
// origin, in the order of RayAxes. shear: minus the direction's x and y over its z, then 1 over its z.
template <class Number>
WAVECREST_INLINE Vec3<Number> laidAcross(Vec3<Number> p, Vec3<Number> shear) {
  return {mulAdd(p.z, shear.x, p.x), mulAdd(p.z, shear.y, p.y), p.z};
}

// Where rays meet the planes of triangles: the distance, and the weights of the second and third corner times their sum
// with the first.
template <class Number>
struct FaceHit {
  Number t, second, third, sum;
};

// Twice the area of (0, p, q). No fused operations: each product is rounded by itself, and rounding keeps the order of
// two numbers. Changes its sign and nothing else when p and q change places.
template <class Number>
WAVECREST_INLINE Number edgeFunction(Vec3<Number> p, Vec3<Number> q) {
  return p.x * q.y - p.y * q.x;
}

// Rays against triangles with corners a, b, c relative to the origins, they and the directions in the order of RayAxes.
// In long thin ones the shortest edge begins or ends at b. shear: of laidAcross. inside: a mask.
//
// The distance is that of the plane and not a mean of the corners' depths: next to a wall the latter would err by the
// rounding of the farthest corner, and a ray that starts in a corner of a room could find the wall behind it.
template <class Number, class MaskOf>
WAVECREST_INLINE FaceHit<Number> intersectFaces(Vec3<Number> a, Vec3<Number> b, Vec3<Number> c, Vec3<Number> direction,
                                                Vec3<Number> shear, MaskOf& inside) {
  const Vec3<Number> p = laidAcross(a, shear), q = laidAcross(b, shear), r = laidAcross(c, shear);
  FaceHit<Number> hit;
  const Number first = edgeFunction(q, r);
  hit.second = edgeFunction(r, p);
  hit.third = edgeFunction(p, q);
  hit.sum = first + hit.second + hit.third;
  const Number zero(0.0f);
  const Number least = min(first, min(hit.second, hit.third)), most = max(first, max(hit.second, hit.third));
  inside = (least >= zero) | (most <= zero);
  // From the edges at b: the cross product of two long edges that are almost parallel would round to another plane. A
  // triangle seen edge-on has no area there: its distance is 0 / 0, a NaN, which every comparison rejects.
  const Vec3<Number> normal = cross(b - a, c - b);
  hit.t = dot(normal, a) / dot(normal, direction);
  return hit;
}

WAVECREST_SIMD_END
