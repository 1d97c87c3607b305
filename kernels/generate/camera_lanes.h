// Camera rays in lanes: pinhole now and always; the lens only where the feature set has it.
#pragma once

#include <cmath>

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct RayLanes {
  Vec3<Real> origin, direction;
};

// Turns uniform numbers into an offset from the pixel's corner that is distributed like the reconstruction filter, so
// that each sample has weight 1 (Ernst et al., "Filter Importance Sampling", 2006).
template <class Real>
WAVECREST_INLINE void filterOffset(const CameraView& camera, Real& x, Real& y) {
  if (camera.filter == FilterKind::tent) {
    const auto tent = [&](Real u) HWY_ATTR {
      const Real rising = sqrt(u + u) - Real(1), falling = Real(1) - sqrt(max(Real(2) - u - u, Real(0)));
      return mulAdd(select(u < Real(0.5f), rising, falling), Real(camera.filterScale), Real(0.5f));
    };
    x = tent(x);
    y = tent(y);
  } else if (camera.filter == FilterKind::gaussian) {
    const Real radius = sqrt(Real(-2) * log(Real(1) - x)) * Real(camera.filterScale);  // Box and Muller 1958
    const auto angle = sinCos2Pi(y);
    x = mulAdd(radius, angle.cos, Real(0.5f));
    y = mulAdd(radius, angle.sin, Real(0.5f));
  }
}

// u.a, u.b: place in the pixel; u.c, u.d: place on the lens.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE RayLanes<typename P::Real> cameraRay(const CameraView& camera, const PixelLanes& pixel,
                                                      const Uniform4& u) {
  using Real = typename P::Real;
  Real dx = to<Real>(u.a), dy = to<Real>(u.b);
  if constexpr (has(kFeatures, kLens)) filterOffset(camera, dx, dy);
  const Real rasterX = to<Real>(toFloat(pixel.x)) + dx, rasterY = to<Real>(toFloat(pixel.y)) + dy;
  const Vec3<Real> onPlane = mulAdd(broadcast<Real>(camera.du), rasterX,
                                    mulAdd(broadcast<Real>(camera.dv), rasterY, broadcast<Real>(camera.corner)));
  const Vec3<Real> origin = broadcast<Real>(camera.origin);
  if constexpr (has(kFeatures, kLens)) {
    if (camera.lensRadius > 0) {
      // Through the point of the plane in focus that the ray by the lens's centre would meet.
      const Vec2<Real> lens = concentricDisc<Real>(to<Real>(u.c), to<Real>(u.d));
      const double scaleU = camera.lensRadius * std::sqrt(camera.inverseDu2);
      const double scaleV = camera.lensRadius * std::sqrt(camera.inverseDv2);
      const Vec3<Real> onLens =
          broadcast<Real>(camera.du) * (lens.x * Real(scaleU)) + broadcast<Real>(camera.dv) * (lens.y * Real(scaleV));
      const Vec3<Real> inFocus = onPlane * Real(camera.focusDistance / camera.planeDepth);
      return {origin + onLens, normalizeFast<P>(inFocus - onLens)};
    }
  }
  return {origin, normalizeFast<P>(onPlane)};
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
