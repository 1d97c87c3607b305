// Directions as places in the square [-1,1]^2: the octahedron |x| + |y| + |z| = 1, seen along z, with its lower half
// folded outwards over the edges of the upper one.
//
// No trigonometry either way, no poles, and neighbours in the square are neighbours on the sphere. A piece of the
// square and its directions have areas in the ratio 1 : (|x| + |y| + |z|)^3 of a unit direction, which is from 1 to
// 5.2: projected onto its face of the octahedron a solid angle grows by (distance to the face)^2 over the cosine
// there, and onto the square by the cosine of the face, 1 / sqrt(3).
#pragma once

#include "kernels/columns/guide_view.h"
#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

struct SquarePoint {
  Float u, v;
  Float solidAngle;  // of an area of 1 there
};

// The fold: from the lower half to outside of the upper one, and back.
WAVECREST_INLINE void foldSquare(Mask lower, Float& u, Float& v) {
  const Float foldedU = copySign(Float(1) - abs(v), u), foldedV = copySign(Float(1) - abs(u), v);
  u = select(lower, foldedU, u);
  v = select(lower, foldedV, v);
}

// direction: unit.
WAVECREST_INLINE SquarePoint toSquare(Vec3<Float> direction) {
  const Float norm = abs(direction.x) + abs(direction.y) + abs(direction.z), inverse = Float(1) / norm;
  SquarePoint point{direction.x * inverse, direction.y * inverse, norm * norm * norm};
  foldSquare(direction.z < Float(0), point.u, point.v);
  return point;
}

// The unit direction of a place, and what an area of 1 there covers.
WAVECREST_INLINE Vec3<Float> fromSquare(Float u, Float v, Float& solidAngle) {
  const Float z = Float(1) - abs(u) - abs(v);
  foldSquare(z < Float(0), u, v);
  const Float inverse = Float(1) / sqrt(mulAdd(u, u, mulAdd(v, v, z * z)));
  solidAngle = inverse * inverse * inverse;
  return {u * inverse, v * inverse, z * inverse};
}

// The bin of a place in the square.
WAVECREST_INLINE UInt binOf(Float u, Float v) {
  const auto coordinate = [](Float a) WAVECREST_LAMBDA {
    const Float scaled = mulAdd(a, Float(kGuideSide / 2.0f), Float(kGuideSide / 2.0f));
    return toUInt(min(max(scaled, Float(0)), Float(static_cast<float>(kGuideSide - 1))));
  };
  return coordinate(u) + shiftLeft<kGuideSideBits>(coordinate(v));
}

WAVECREST_SIMD_END
