// Camera rays in lanes: pinhole now and always; the lens only where the feature set has it.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct RayLanes {
  Vec3<Real> origin, direction;
};

// u.a, u.b: place in the pixel; u.c, u.d: place on the lens.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE RayLanes<typename P::Real> cameraRay(const CameraView& camera, const PixelLanes& pixel,
                                                      const Uniform4& u) {
  using Real = typename P::Real;
  const Real rasterX = to<Real>(toFloat(pixel.x)) + to<Real>(u.a);
  const Real rasterY = to<Real>(toFloat(pixel.y)) + to<Real>(u.b);
  const Vec3<Real> direction = mulAdd(broadcast<Real>(camera.du), rasterX,
                                      mulAdd(broadcast<Real>(camera.dv), rasterY, broadcast<Real>(camera.corner)));
  return {broadcast<Real>(camera.origin), normalizeFast<P>(direction)};
}

WAVECREST_SIMD_END
