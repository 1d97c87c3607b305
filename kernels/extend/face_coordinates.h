// From a hit in a leaf to coordinates of its primitive, in lanes.
#pragma once

#include "kernels/extend/inset_lanes.h"
#include "kernels/extend/leaves.h"

WAVECREST_SIMD_BEGIN

// Coordinates in the primitive, kept off its edges, from the weights of the second and third corner; of spheres, which
// have t and 0, those. id: of the slot that was hit.
WAVECREST_INLINE HitCoordinates<Float> coordinatesInFace(UInt id, Float second, Float third) {
  const UInt kind = shiftRight<kFaceKindShift>(id);
  const auto is = [&](FaceKind k) HWY_ATTR { return kind == UInt(static_cast<uint32_t>(k)); };
  const Mask lower = is(FaceKind::lowerHalf), upper = is(FaceKind::upperHalf), sphere = is(FaceKind::sphere);
  const Float both = second + third, one(1);
  const auto at = insideEdges(select(lower, both, select(upper, one - both, second)), select(upper, one - third, third),
                              !(lower | upper));
  return {select(sphere, second, at.u), select(sphere, third, at.v)};
}

WAVECREST_SIMD_END
