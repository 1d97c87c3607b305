// Emission of area and infinite lights, and the densities with which next event estimation would have found them.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/shade/surface_lanes.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE UInt lightKind(LightKind kind) { return UInt(static_cast<uint32_t>(kind)); }

// Lights that are met by leaving the scene.
WAVECREST_INLINE Mask isInfinite(UInt kind) {
  return (kind == lightKind(LightKind::constant)) | (kind == lightKind(LightKind::envmap)) |
         (kind == lightKind(LightKind::directional));
}

// 1 - cos of the half angle under which a sphere of squared radius r2 is seen from squared distance d2.
template <class Real>
WAVECREST_INLINE Real sphereConeHeight(Real r2, Real d2) {
  return oneMinusCosFromSin2(min(r2 / d2, Real(1)));
}

// Receivers this close to a spherical light sample its area uniformly instead of its cone.
constexpr double kInsideSphere = 1.0002;

// Density over the light's area, light selection included, with which nextEvent at `receiver` samples `point` on an
// area light; n0 is the cosine at the light and dist2 the squared distance.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE typename P::Real directPdfA(const SceneView<typename P::Storage>& scene,
                                             const RecordLanes<LightRecord<typename P::Storage>>& at,
                                             Vec3<typename P::Real> receiver, typename P::Real n0,
                                             typename P::Real dist2) {
  using Real = typename P::Real;
  const auto& fields = *scene.lights;
  Real pdfA = at(fields.inverseArea);
  if constexpr (has(kFeatures, kCurvedShapes)) {
    const Mask sphere = at(fields.kind) == lightKind(LightKind::sphere);
    if (any(sphere)) {
      const Real radius = at(fields.radius);
      const Real r2 = radius * radius;
      const Real d2 = length2(at(fields.p0) - receiver);
      const Mask outside = sphere & (d2 > r2 * Real(kInsideSphere));
      const Real pdfW = Real(kInvPi / 2) / sphereConeHeight(r2, d2);
      pdfA = select(outside, pdfW * n0 / dist2, pdfA);
    }
  }
  return pdfA * at(fields.pick);
}

WAVECREST_SIMD_END
