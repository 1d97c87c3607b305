// Where rays start and shadow rays end, so that they do not meet the surfaces there (offset.h).
#pragma once

#include "kernels/extend/offset.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// Where a ray into `direction` may start without meeting the surface of `position` again.
template <class Real>
WAVECREST_INLINE Vec3<Real> offsetOrigin(Vec3<Real> position, Vec3<Real> normal, Real offset, Vec3<Real> direction) {
  return mulAdd(normal, copySign(offset, dot(normal, direction)), position);
}

// How far from the surface that it goes to a shadow ray ends. offset: for rays that start there. length: of the ray.
template <class Real>
WAVECREST_INLINE Real endOffset(Real offset, Real length) {
  return mulAdd(length, Real(kEndGamma), offset);
}

WAVECREST_SIMD_END
