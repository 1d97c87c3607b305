// Tests of rays against what the hierarchy of bvh.h holds: one ray against the eight children of a node or the slots of
// a leaf, or a block of rays against one of them at a time. Number: FloatGroup or Float.
#pragma once

#include "kernels/extend/bvh.h"
#include "kernels/extend/sphere_lanes.h"
#include "kernels/simd/group.h"
#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

// Where rays meet the planes of triangles: the distance, and the weights of the second and third corner times their sum
// with the first.
template <class Number>
struct FaceHit {
  Number t, second, third, sum;
};

// d . (p x q), in the form that changes its sign and nothing else when p and q change places.
template <class Number>
WAVECREST_INLINE Number edgeFunction(Vec3<Number> p, Vec3<Number> q, Vec3<Number> direction) {
  return dot(cross(p - q, p + q), direction);
}

template <class Number>
WAVECREST_INLINE Number greatestPart(Vec3<Number> a) {
  return max(max(abs(a.x), abs(a.y)), abs(a.z));
}

// Rays against triangles with corners a, b, c relative to the rays' origins. size: BvhFaces::size. direction need not
// be unit. inside: a mask of where the three edge functions (Plücker coordinates) have one sign, but for a bound on
// their rounding. With E = size and A, D the greatest parts of a and the direction, no part of p - q exceeds E, none of
// p + q 2 (A + E), none of their cross product 4 E (A + E); seven roundings, and three terms of a sum with D: 84 unit
// roundoffs of D E (A + E). As seen from the origin that is an angle of 5e-6.
template <class Number, class MaskOf>
WAVECREST_INLINE FaceHit<Number> intersectFaces(Vec3<Number> a, Vec3<Number> b, Vec3<Number> c, Number size,
                                                Vec3<Number> direction, MaskOf& inside) {
  FaceHit<Number> hit;
  hit.second = edgeFunction(c, a, direction);
  hit.third = edgeFunction(a, b, direction);
  const Number first = edgeFunction(b, c, direction);
  hit.sum = first + hit.second + hit.third;
  const Number tolerance = Number(84 * 0x1p-24f) * greatestPart(direction) * size * (greatestPart(a) + size);
  const Number least = min(first, min(hit.second, hit.third)), most = max(first, max(hit.second, hit.third));
  inside = (least >= -tolerance) | (most <= tolerance);
  const Vec3<Number> normal = cross(b - a, c - a);
  hit.t = dot(normal, a) / dot(normal, direction);
  return hit;
}

WAVECREST_SIMD_END
