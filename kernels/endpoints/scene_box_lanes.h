// Where light from infinitely far away enters the scene: through the faces of its bounding box that it shines on.
//
// Light paths from distant lights start on these faces. Seen along a direction the faces do not overlap, so a point
// with a uniform density over the area that they cover there is a face chosen by its share of that area and a uniform
// point on it. The area, a sum of three products, is at most 0.74 of the bounding sphere's disc, and much less for a
// flat scene.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// A quarter of the area that each axis's pair of faces covers when seen along a direction.
template <class Real, class S>
WAVECREST_INLINE Vec3<Real> faceShares(const SceneView<S>& scene, Vec3<Real> direction) {
  const auto& half = scene.halfExtent;
  return {abs(direction.x) * Real(half[1] * half[2]), abs(direction.y) * Real(half[0] * half[2]),
          abs(direction.z) * Real(half[0] * half[1])};
}

// Area of the box's projection along a unit direction (METHODS 2.2).
template <class Real, class S>
WAVECREST_INLINE Real projectedArea(const SceneView<S>& scene, Vec3<Real> direction) {
  const Vec3<Real> shares = faceShares(scene, direction);
  return (shares.x + shares.y + shares.z) * Real(4);
}

// Where light of a direction enters. u, v: place on the face; which: chooses the face.
template <class Real, class S>
WAVECREST_INLINE Vec3<Real> pointOnBox(const SceneView<S>& scene, Vec3<Real> direction, Real u, Real v, Real which) {
  const Vec3<Real> shares = faceShares(scene, direction);
  const Real chosen = which * (shares.x + shares.y + shares.z);
  const Mask alongX = chosen < shares.x, alongZ = chosen >= shares.x + shares.y;
  const Real one(1), a = u + u - one, b = v + v - one;
  const Vec3<Real> entered{copySign(one, -direction.x), copySign(one, -direction.y), copySign(one, -direction.z)};
  const Vec3<Real> onBox{select(alongX, entered.x, a), select(alongX, a, select(alongZ, b, entered.y)),
                         select(andNot(alongZ, alongX), entered.z, b)};
  return {mulAdd(onBox.x, Real(scene.halfExtent[0]), Real(scene.center[0])),
          mulAdd(onBox.y, Real(scene.halfExtent[1]), Real(scene.center[1])),
          mulAdd(onBox.z, Real(scene.halfExtent[2]), Real(scene.center[2]))};
}

WAVECREST_SIMD_END
