// Tests of one primitive against a block of rays, for the small-scene intersector.
#pragma once

#include "kernels/extend/small_scene.h"
#include "kernels/extend/sphere_lanes.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE Float dotForm(const float (&a)[3], Vec3<Float> b) {
  return mulAdd(Float(a[0]), b.x, mulAdd(Float(a[1]), b.y, Float(a[2]) * b.z));
}

struct PlaneHit {
  Float t, u, v;
  Float slowness;  // 1 / |speed towards the plane|
};

// Where the rays meet the plane, in its centred coordinates. A ray within the plane gives NaN or infinity, which fails
// every comparison that follows.
WAVECREST_INLINE PlaneHit intersectPlane(const PlaneForm& plane, Vec3<Float> origin, Vec3<Float> direction) {
  const Float speed = dotForm(plane.normal, direction);
  const Float gap = Float(plane.distance) - dotForm(plane.normal, origin);
  PlaneHit hit;
  const Float inverseSpeed = approximateReciprocal(speed);
  hit.slowness = abs(inverseSpeed);
  hit.t = gap * inverseSpeed;
  const Vec3<Float> point = mulAdd(direction, hit.t, origin);
  hit.u = dotForm(plane.uAxis, point) + Float(plane.uOffset);
  hit.v = dotForm(plane.vAxis, point) + Float(plane.vOffset);
  return hit;
}
WAVECREST_INLINE Mask insideQuad(const PlaneHit& hit, const PlaneLimits& limits) {
  return max(abs(hit.u), abs(hit.v)) <= mulAdd(hit.slowness, Float(limits.grazing), Float(1));
}
WAVECREST_INLINE Mask insideTriangle(const PlaneHit& hit, const PlaneLimits& limits) {
  const Float margin = mulAdd(hit.slowness, Float(limits.grazing), Float(limits.margin));
  return min(min(hit.u, hit.v), Float(1) - hit.u - hit.v) >= -margin;
}

WAVECREST_INLINE Float intersectSphere(const SphereForm& sphere, Vec3<Float> origin, Vec3<Float> direction) {
  const Vec3<Float> center{sphere.center[0], sphere.center[1], sphere.center[2]};
  return intersectSpheres(center, Float(sphere.radius), origin, direction);
}

WAVECREST_SIMD_END
