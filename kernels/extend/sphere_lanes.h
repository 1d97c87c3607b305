// Rays against spheres. Number: Float, or FloatGroup for one ray against several spheres.
#pragma once

#include "kernels/simd/vec3.h"

WAVECREST_SIMD_BEGIN

// The nearest t > 0 at which the rays meet the spheres, or a negative number. The discriminant is taken from the point
// of the ray nearest to the centre, and the roots from the one that does not cancel (Haines et al., "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019). direction need not be unit.
template <class Number>
WAVECREST_INLINE Number intersectSpheres(Vec3<Number> center, Number radius, Vec3<Number> origin,
                                         Vec3<Number> direction) {
  const Vec3<Number> toOrigin = origin - center;
  const Number a = length2(direction);
  const Number b = -dot(toOrigin, direction);
  const Number r2 = radius * radius;
  const Vec3<Number> nearest = mulAdd(direction, b / a, toOrigin);
  const Number discriminant = r2 - length2(nearest);
  const Number q = b + copySign(sqrt(max(a * discriminant, Number(0.0f))), b);
  const Number c = length2(toOrigin) - r2;
  const Number t0 = c / q, t1 = q / a;
  const Number first = min(t0, t1), second = max(t0, t1);
  const Number t = select(first > Number(0.0f), first, second);
  return select(discriminant >= Number(0.0f), t, Number(-1.0f));
}

WAVECREST_SIMD_END
