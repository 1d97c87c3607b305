// Emission of area and infinite lights, and the densities with which next event estimation would have found them.
#pragma once

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/math.h"
#include "kernels/surface/surface_lanes.h"
#include "kernels/surface/texture_lanes.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE UInt lightKind(LightKind kind) { return UInt(static_cast<uint32_t>(kind)); }

// Lights that are met by leaving the scene.
WAVECREST_INLINE Mask isInfinite(UInt kind) {
  return (kind == lightKind(LightKind::constant)) | (kind == lightKind(LightKind::envmap)) |
         (kind == lightKind(LightKind::directional));
}

// The light of each lane.
template <class Real>
struct LightLanes {
  Vec3<Real> p0, e1, e2, normal, radiance;
  Real pick, inverseArea, radius, offset, cutoffHeight, beamHeight;
  UInt kind, texture;
};
// Where the scene has one light its fields are broadcast: a lane's gather costs as much as all broadcasts.
template <class S>
WAVECREST_INLINE auto loadLight(const SceneView<S>& scene, UInt index) {
  const LightRecord<S>& fields = *scene.lights;
  const auto load = [&](auto at) WAVECREST_LAMBDA {
    using Real = decltype(at(fields.pick));
    return LightLanes<Real>{at(fields.p0),       at(fields.e1),           at(fields.e2),          at(fields.normal),
                            at(fields.radiance), at(fields.pick),         at(fields.inverseArea), at(fields.radius),
                            at(fields.offset),   at(fields.cutoffHeight), at(fields.beamHeight),  at(fields.kind),
                            at(fields.texture)};
  };
  if (scene.lightCount == 1) return load(OneRecord());
  return load(RecordLanes<LightRecord<S>>(scene.lights, index));
}

// ---- environment map ------------------------------------------------------------------------------------------------

// Longitude and colatitude of unit directions in the map's frame, as fractions of the map (Mitsuba's convention: +y up,
// +z in the middle, -z on the seam of the left and right edges).
template <class Real>
struct MapPoint {
  Float u, v;
  Real sinTheta;
  Real sun;  // 1 within the sun, else 0
};
template <class Real>
WAVECREST_INLINE MapPoint<Real> mapPoint(const EnvironmentView& map, Vec3<Real> direction) {
  const auto row = [&](size_t i) WAVECREST_LAMBDA {
    return dot(direction, Vec3<Real>{Real(map.toLocal[i][0]), Real(map.toLocal[i][1]), Real(map.toLocal[i][2])});
  };
  const Real x = row(0), y = row(1), z = row(2);
  Real sun(0);
  if (map.sunShare > 0) {
    // By the chord: the cosine of half a degree is 1 to five digits.
    sun = zeroUnless(length2(direction - broadcast<Real>(map.sunDirection)) <= Real(map.sunChord2), Real(1));
  }
  const Float turn = to<Float>(atan2(x, -z)) * Float(0.5f * static_cast<float>(kInvPi));
  // Near the poles y is 1 to all digits, while x and z still tell how far away they are.
  const Real sinTheta = sqrt(mulAdd(x, x, z * z));
  return {turn - floor(turn), to<Float>(atan2(sinTheta, y)) * Float(static_cast<float>(kInvPi)), sinTheta, sun};
}

// Radiance of the map: bilinear, columns by their centres and around, rows from pole to pole.
template <class Real>
WAVECREST_INLINE Vec3<Real> mapRadiance(const EnvironmentView& map, const MapPoint<Real>& point) {
  const UInt width(map.width), height(map.height);
  const Float x = point.u * toFloat(width) - Float(0.5f);
  const Float y = min(max(point.v, Float(0)), Float(1)) * Float(static_cast<float>(map.height - 1));
  const Float x0 = floor(x), y0 = floor(y), fx = x - x0, fy = y - y0;
  const UInt left = select(x0 < Float(0), width - UInt(1u), toUInt(max(x0, Float(0))));
  const UInt column0 = min(left, width - UInt(1u));
  const UInt column1 = select(column0 == width - UInt(1u), UInt(0u), column0 + UInt(1u));
  const UInt row0 = min(toUInt(y0), height - UInt(1u)), row1 = min(row0 + UInt(1u), height - UInt(1u));
  const auto texel = [&](UInt column, UInt row) WAVECREST_LAMBDA {
    const UInt at = (row * width + column) * UInt(3u);
    return Vec3<Float>{gather(map.texels, at), gather(map.texels + 1, at), gather(map.texels + 2, at)};
  };
  const Vec3<Float> upper = texel(column0, row0) * (Float(1) - fx) + texel(column1, row0) * fx;
  const Vec3<Float> lower = texel(column0, row1) * (Float(1) - fx) + texel(column1, row1) * fx;
  Vec3<Real> radiance = to<Real>(upper * (Float(1) - fy) + lower * fy);
  if (map.sunShare > 0) radiance = radiance + broadcast<Real>(map.sunRadiance) * point.sun;
  if (map.isSky) radiance = select(point.v > Float(0.5f), Vec3<Real>{Real(0), Real(0), Real(0)}, radiance);
  return radiance;
}

WAVECREST_INLINE UInt packTexel(UInt column, UInt row) { return column | shiftLeft<kTexelBits>(row); }

// Density per solid angle with which a direction is sampled from the map, light selection excluded.
template <class Real>
WAVECREST_INLINE Real mapPdfW(const EnvironmentView& map, const MapPoint<Real>& point) {
  const UInt width(map.width), height(map.height);
  const UInt column = min(toUInt(point.u * toFloat(width)), width - UInt(1u));
  const UInt row = min(toUInt(point.v * toFloat(height)), height - UInt(1u));
  const Real probability = to<Real>(gather(map.probability, row * width + column));
  const double perTexel = static_cast<double>(map.width) * map.height * kInvPi * kInvPi / 2;
  const Real pdf = probability * Real(perTexel) / max(point.sinTheta, Real(1e-9f));
  if (!(map.sunShare > 0)) return pdf;
  const double share = static_cast<double>(map.sunShare);
  return mulAdd(point.sun, Real(share * kInvPi / map.sunChord2), pdf * Real(1 - share));
}

// A direction towards the environment: alias table over texels, then uniform within the texel.
//
// A number of 24 bits cannot choose among more than 2^24 entries, so one chooses the entry's row and another its
// column. What the first leaves extends the second, of which all but log2(width) bits are then the place within the
// texel. Rows are drawn with an error of 2^-24 at most, together as alone, and none where their number is a power of
// two.
template <class Real>
WAVECREST_INLINE Vec3<Real> sampleTexels(const EnvironmentView& map, const Uniform4& u) {
  const auto width = static_cast<float>(map.width);
  const Float rows = u.a * Float(static_cast<float>(map.height)), columns = u.c * Float(width);
  const UInt entryRow = min(toUInt(rows), UInt(map.height - 1)),
             entryColumn = min(toUInt(columns), UInt(map.width - 1));
  const Float across = mulAdd(rows - toFloat(entryRow), Float(width * 0x1p-24f), columns - toFloat(entryColumn));
  const RecordLanes<AliasEntry> at(map.table, entryRow * UInt(map.width) + entryColumn);
  const UInt texel = select(u.b < at(map.table->keep), packTexel(entryColumn, entryRow), at(map.table->other));
  const UInt row = shiftRight<kTexelBits>(texel), column = texel & UInt((1u << kTexelBits) - 1);
  const Real phi = (to<Real>(toFloat(column)) + to<Real>(across)) * Real(2 * kPi / map.width);
  const Real theta = (to<Real>(toFloat(row)) + to<Real>(u.d)) * Real(kPi / map.height);
  const auto azimuth = sinCos(phi), polar = sinCos(theta);
  const Vec3<Real> local{azimuth.sin * polar.sin, polar.cos, -azimuth.cos * polar.sin};
  const auto column3 = [&](size_t i) WAVECREST_LAMBDA {  // the inverse of a rotation is its transpose
    return Real(map.toLocal[0][i]) * local.x + Real(map.toLocal[1][i]) * local.y + Real(map.toLocal[2][i]) * local.z;
  };
  return {column3(0), column3(1), column3(2)};
}

// The same, or towards the sun. The place within the texel chooses, and what that leaves of it is used again: the other
// numbers choose among texels as they do without a sun.
template <class Real>
WAVECREST_INLINE Vec3<Real> sampleMap(const EnvironmentView& map, const Uniform4& u) {
  if (!(map.sunShare > 0)) return sampleTexels<Real>(map, u);
  const Float share(map.sunShare);
  const Mask toSun = u.d < share;
  const Float rest = min(max((u.d - share) / (Float(1) - share), Float(0)), Float(0x1.fffffep-1f));
  const Vec3<Real> local = uniformCone(to<Real>(u.a), to<Real>(u.b), Real(map.sunChord2 / 2));
  const Vec3<Real> sun = Frame<Real>::fromNormal(broadcast<Real>(map.sunDirection)).toWorld(local);
  return select(toSun, sun, sampleTexels<Real>(map, {u.a, u.b, u.c, rest}));
}

// ---- beams: spot lights and projectors ------------------------------------------------------------------------------

WAVECREST_INLINE Mask isBeam(UInt kind) {
  return (kind == lightKind(LightKind::spot)) | (kind == lightKind(LightKind::projector));
}

// Narrow beams are measured by 1 - cosine of angles, which float knows to all digits where the cosine is nearly 1.
//
// The angle of which 1 - cosine is `height`, 0 to 2.
template <class Real>
WAVECREST_INLINE Real angleOfHeight(Real height) {
  const Real one(1), half = min(height * Real(0.5f), one);
  const Real quarter = atan2(sqrt(half), sqrt(one - half));
  return quarter + quarter;
}

// Share of the intensity in unit directions around a spot's axis: 1 within the beam, 0 outside the cutoff, linear in
// the angle between, as Mitsuba's spot.
template <class Real>
WAVECREST_INLINE Real spotFalloff(const LightLanes<Real>& light, Vec3<Real> direction) {
  const Real height = length2(direction - light.normal) * Real(0.5f);
  const Real angle = angleOfHeight(height), cutoff = angleOfHeight(light.cutoffHeight),
             beam = angleOfHeight(light.beamHeight);
  const Real ramp = (cutoff - angle) / max(cutoff - beam, cutoff * Real(1e-6f));
  return zeroUnless(height < light.cutoffHeight, select(height <= light.beamHeight, Real(1), ramp));
}

// 1 / cos^3 of the angle from the axis, in front of the light: area on the plane at distance 1 per solid angle.
template <class Real>
WAVECREST_INLINE Real areaPerSolidAngle(Real cosine) {
  const Real inverse = Real(1) / max(cosine, Real(1e-6f));
  return inverse * inverse * inverse;
}

// Intensity in a unit direction of travel over the light's `radiance`, in lanes that have a beam. A spot falls off
// around its axis; a projector lights its picture on the plane at distance 1 evenly; both may have a texture.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE Vec3<typename P::Real> beamFactor(const SceneView<typename P::Storage>& scene,
                                                   const LightLanes<typename P::Real>& light,
                                                   Vec3<typename P::Real> direction) {
  using Real = typename P::Real;
  const Real one(1), cosine = dot(direction, light.normal);
  Real factor = spotFalloff(light, direction);
  const Mask projector = light.kind == lightKind(LightKind::projector);
  const bool textures = has(kFeatures, kTextures) && scene.textures != nullptr;
  if (none(projector) && !textures) return {factor, factor, factor};

  // Place on the picture: e1 and e2 lead from its middle to where x or y is 1, divided by their squared lengths.
  const Real inverse = one / max(cosine, Real(1e-6f));
  const Real x = dot(direction, light.e1) * inverse, y = dot(direction, light.e2) * inverse;
  const Mask inside = (cosine > Real(0)) & (abs(x) <= one) & (abs(y) <= one);
  factor = select(projector, zeroUnless(inside, areaPerSolidAngle(cosine)), factor);
  Vec3<Real> color{factor, factor, factor};
  if constexpr (has(kFeatures, kTextures)) {
    const Mask lit = isBeam(light.kind) & (factor > Real(0));
    const UInt texture = select(lit, light.texture, UInt(kNoIndex));
    const Real half(0.5f);
    color = color * to<Real>(textureFactor(scene.textures, scene.texels, texture, to<Float>(mulAdd(x, half, half)),
                                           to<Float>(mulAdd(y, half, half))));
  }
  return color;
}

// Density per solid angle with which a beam emits in a direction at this cosine from its axis: uniform in the cone of a
// spot, uniform on the picture of a projector.
template <class Real>
WAVECREST_INLINE Real beamPdfW(const LightLanes<Real>& light, Real cosine) {
  const Real cone = Real(kInvPi / 2) / max(light.cutoffHeight, Real(1e-30f));
  const Mask projector = light.kind == lightKind(LightKind::projector);
  if (none(projector)) return cone;
  return select(projector, light.inverseArea * areaPerSolidAngle(cosine), cone);
}

// ---- area lights ----------------------------------------------------------------------------------------------------

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
WAVECREST_INLINE typename P::Real directPdfA(const LightLanes<typename P::Real>& light, Vec3<typename P::Real> receiver,
                                             typename P::Real n0, typename P::Real dist2) {
  using Real = typename P::Real;
  Real pdfA = light.inverseArea;
  if constexpr (has(kFeatures, kCurvedShapes)) {
    const Mask sphere = light.kind == lightKind(LightKind::sphere);
    if (any(sphere)) {
      const Real r2 = light.radius * light.radius;
      const Real d2 = length2(light.p0 - receiver);
      const Mask outside = sphere & (d2 > r2 * Real(kInsideSphere));
      const Real pdfW = Real(kInvPi / 2) / sphereConeHeight(r2, d2);
      pdfA = select(outside, pdfW * n0 / dist2, pdfA);
    }
  }
  return pdfA * light.pick;
}

WAVECREST_SIMD_END
