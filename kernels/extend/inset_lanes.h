// Coordinates of hits kept off the edges of their primitive, in lanes; see kInset.
#pragma once

#include "kernels/extend/offset.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct HitCoordinates {
  Real u, v;
};

// In a quad: u, v in [0, 1].
template <class Real>
WAVECREST_INLINE HitCoordinates<Real> insideQuad(Real u, Real v) {
  const Real inset(kInset), rest(1 - kInset);
  return {min(max(u, inset), rest), min(max(v, inset), rest)};
}

// In a quad, or where `triangle` holds in its half with u + v <= 1.
template <class Real>
WAVECREST_INLINE HitCoordinates<Real> insideEdges(Real u, Real v, Mask triangle) {
  const auto at = insideQuad(u, v);
  const Real scale = select(triangle, min(Real(1), Real(1 - kInset) / (at.u + at.v)), Real(1));
  return {at.u * scale, at.v * scale};
}

WAVECREST_SIMD_END
