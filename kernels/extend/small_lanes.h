// Tests of one primitive against a block of rays, for the small-scene intersector.
#pragma once

#include "kernels/extend/small_scene.h"
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

// The nearest t > 0 at which the rays meet the sphere, or a negative number. The discriminant is taken from the point
// of the ray nearest to the centre, and the roots from the one that does not cancel (Haines et al., "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019). direction need not be unit.
WAVECREST_INLINE Float intersectSphere(const SphereForm& sphere, Vec3<Float> origin, Vec3<Float> direction) {
  const Vec3<Float> toOrigin = origin - Vec3<Float>{sphere.center[0], sphere.center[1], sphere.center[2]};
  const Float a = length2(direction);
  const Float b = -dot(toOrigin, direction);
  const Float r2 = Float(sphere.radius * sphere.radius);
  const Vec3<Float> nearest = mulAdd(direction, b / a, toOrigin);
  const Float discriminant = r2 - length2(nearest);
  const Float q = b + copySign(sqrt(max(a * discriminant, Float(0))), b);
  const Float c = length2(toOrigin) - r2;
  const Float t0 = c / q, t1 = q / a;
  const Float first = min(t0, t1), second = max(t0, t1);
  const Float t = select(first > Float(0), first, second);
  return select(discriminant >= Float(0), t, Float(-1));
}

WAVECREST_SIMD_END
