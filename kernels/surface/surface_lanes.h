// From a hit to the surface point: position, normal and a bound on the position's error.
//
// The position comes from the primitive, not from the ray, so its error does not grow with the ray's length. The offset
// bounds that error along the normal plus the error with which an intersector evaluates the same plane, so a ray that
// starts `offset` off the surface cannot meet the surface it starts on (kernels/extend/offset.h).
#pragma once

#include "kernels/extend/inset_lanes.h"
#include "kernels/extend/offset_lanes.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct SurfacePoint {
  Vec3<Real> position, normal;
  Real offset;
  Real u, v;  // coordinates in the primitive
};

template <class P, uint32_t kFeatures>
WAVECREST_INLINE SurfacePoint<typename P::Real> surfacePoint(const SceneView<typename P::Storage>& scene,
                                                             const PrimitiveLanes<typename P::Storage>& at,
                                                             Vec3<typename P::Real> rayOrigin,
                                                             Vec3<typename P::Real> rayDirection, Float hitU,
                                                             Float hitV) {
  using Real = typename P::Real;
  const auto& fields = *scene.primitives;
  SurfacePoint<Real> surface;
  const Vec3<Real> p0 = at(fields.p0), e1 = at(fields.e1), e2 = at(fields.e2);
  surface.normal = at(fields.normal);

  // Intersectors work in float; under the double policy the point where the double ray meets the plane is found anew.
  Real u = to<Real>(hitU), v = to<Real>(hitV);
  if constexpr (sizeof(typename P::Storage) == sizeof(double)) {
    const Vec3<Real> h = cross(rayDirection, e2);
    const Real inverse = Real(1) / dot(e1, h);
    const Vec3<Real> s = rayOrigin - p0;
    // Clamped to where the primitive can be: a ray that grazes its plane is ill-conditioned.
    const auto inside = insideEdges(dot(s, h) * inverse, dot(rayDirection, cross(s, e1)) * inverse,
                                    at(fields.kind) == UInt(static_cast<uint32_t>(PrimitiveKind::triangle)));
    u = inside.u;
    v = inside.v;
  }
  surface.u = u;
  surface.v = v;
  const Vec3<Real> a = e1 * u, b = e2 * v;
  surface.position = p0 + a + b;
  Vec3<Real> extent = abs(p0) + abs(a) + abs(b);

  if constexpr (has(kFeatures, kCurvedShapes)) {
    if (scene.spheres) {
      const Mask sphere = at(fields.kind) == UInt(static_cast<uint32_t>(PrimitiveKind::sphere));
      if (any(sphere)) {
        // (u, v) of a sphere carries the hit distance in u. Projecting onto the sphere removes the ray's error.
        const Vec3<Real> outward = normalize(mulAdd(rayDirection, to<Real>(hitU), rayOrigin) - p0);
        const Vec3<Real> onSphere = mulAdd(outward, e1.x, p0);
        surface.position = select(sphere, onSphere, surface.position);
        surface.normal = select(sphere, outward * e1.y, surface.normal);
        const Vec3<Real> reach{e1.x, e1.x, e1.x};
        extent = select(sphere, abs(p0) + reach, extent);
      }
    }
  }
  surface.offset = dot(abs(surface.normal), extent) * Real(kOffsetGamma);
  // The plane equation also rounds in the components that lie in the plane.
  surface.offset = max(surface.offset, maxComponent(extent) * Real(4 * kUnitRoundoff));
  return surface;
}

WAVECREST_SIMD_END
