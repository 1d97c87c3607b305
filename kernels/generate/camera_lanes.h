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

// Density per solid angle of the camera rays of one pixel: D^2 / cos^3, D the distance in pixels at which a pixel has
// area 1 (METHODS 4.1).
template <class P>
WAVECREST_INLINE typename P::Real cameraPdfW(const CameraView& camera, Vec3<typename P::Real> direction) {
  using Real = typename P::Real;
  const Real cosine = dot(direction, broadcast<Real>(camera.axis));
  return Real(camera.pixelDistance * camera.pixelDistance) / (cosine * cosine * cosine);
}

// Where a point is seen: raster position, distance to the lens and density per area of the pixel's rays at the point,
// without the cosine there.
template <class Real>
struct Projection {
  Real rasterX, rasterY;
  Vec3<Real> direction;  // unit, from the point to the lens
  Vec3<Real> lens;       // the point on the lens
  Real pdf;              // D^2 / (cos^3 d^2)
  Mask inFront;
};
template <class P>
WAVECREST_INLINE Projection<typename P::Real> project(const CameraView& camera, Vec3<typename P::Real> point) {
  using Real = typename P::Real;
  Projection<Real> out;
  out.lens = broadcast<Real>(camera.origin);
  const Vec3<Real> fromLens = point - out.lens;
  const Real dist2 = length2(fromLens);
  const Real inverseDistance = reciprocalSqrt<P>(max(dist2, Real(1e-37f)));
  out.direction = fromLens * -inverseDistance;
  const Real along = dot(fromLens, broadcast<Real>(camera.axis));
  out.inFront = along > Real(0);
  // The image plane: corner + x du + y dv, at depth planeDepth along the axis.
  const Vec3<Real> onPlane = fromLens * (Real(camera.planeDepth) / along) - broadcast<Real>(camera.corner);
  out.rasterX = dot(onPlane, broadcast<Real>(camera.du)) * Real(camera.inverseDu2);
  out.rasterY = dot(onPlane, broadcast<Real>(camera.dv)) * Real(camera.inverseDv2);
  const Real inverseCosine = reciprocal<P>(along * inverseDistance);
  out.pdf = Real(camera.pixelDistance * camera.pixelDistance) * inverseCosine * inverseCosine * inverseCosine *
            inverseDistance * inverseDistance;
  return out;
}

WAVECREST_SIMD_END
