// Sampling a point on a light, or a direction to an infinite one, as seen from a receiver (METHODS 2.2).
#pragma once

#include "kernels/endpoints/light_lanes.h"
#include "kernels/endpoints/scene_box_lanes.h"
#include "kernels/extend/offset_lanes.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/surface/texture_lanes.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE Mask select(Mask m, Mask yes, Mask no) { return (m & yes) | andNot(no, m); }

template <class Real>
struct LightSample {
  Vec3<Real> direction;  // unit, from the receiver
  Vec3<Real> end;        // where the shadow segment ends, clear of the light's own surface
  Vec3<Real> radiance;   // radiance; intensity for point lights, perpendicular irradiance for directional ones
  Real pdf;              // per solid angle at the receiver, selection included; delta lights: formal, without the delta
  Real emissionPdf;      // of emitting this ray, selection included, over the cosine at the light where there is one
  Mask delta;            // no other strategy can find this light
  Mask valid;
};

// Picks a light by the alias table: one number chooses the entry, another keeps or replaces it.
template <class S>
WAVECREST_INLINE UInt pickLight(const SceneView<S>& scene, Float entry, Float keep) {
  if (scene.lightCount == 1) return UInt(0u);
  const UInt index = min(toUInt(entry * Float(static_cast<float>(scene.lightCount))), UInt(scene.lightCount - 1));
  const RecordLanes<AliasEntry> at(scene.lightTable, index);
  return select(keep < at(scene.lightTable->keep), index, at(scene.lightTable->other));
}

namespace {

// A point of a sphere light: uniform in the cone of directions that the sphere fills, or uniform over its area for
// receivers inside of it or almost on it. normal: outward. outside: lanes that sampled the cone. coneHeight: 1 - cos of
// its half angle.
template <class P>
WAVECREST_INLINE void sampleSphere(const LightLanes<typename P::Real>& light, Vec3<typename P::Real> receiver,
                                   typename P::Real u, typename P::Real v, Vec3<typename P::Real>& point,
                                   Vec3<typename P::Real>& normal, typename P::Real& coneHeight, Mask& outside) {
  using Real = typename P::Real;
  const Real r2 = light.radius * light.radius;
  const Vec3<Real> toCenter = light.p0 - receiver;
  const Real d2 = length2(toCenter);
  outside = d2 > r2 * Real(kInsideSphere);
  coneHeight = sphereConeHeight(r2, d2);
  const Real distance = sqrt(d2);
  const Frame<Real> frame = Frame<Real>::fromNormal(toCenter * (Real(1) / distance));
  // `entry` is where the direction enters the sphere, relative to the sphere's centre, in a frame whose z axis is the
  // axis of the cone. Its z is near * local.z - distance. For a small sphere far away that difference would cancel;
  // with 1 - local.z^2 = sin2 put in, it is a sum of two positive terms.
  const Vec3<Real> local = uniformCone(u, v, coneHeight);
  const Real sin2 = local.x * local.x + local.y * local.y;
  const Real halfChord = sqrt(max(r2 - d2 * sin2, Real(0)));
  const Real near = distance * local.z - halfChord;
  const Vec3<Real> entry{near * local.x, near * local.y, -(distance * sin2 + local.z * halfChord)};
  const Vec3<Real> fromCone = frame.toWorld(normalize(entry));
  const Vec3<Real> fromArea = uniformSphere<Real>(u, v);
  normal = select(outside, fromCone, fromArea);
  point = mulAdd(normal, light.radius, light.p0);
}

}  // namespace

// Spot lights, projectors, directional and environment lights, in the lanes that have them. Densities are those of
// METHODS 2.2, without the choice of the light. more: four numbers for the environment map.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE void addRareLights(const SceneView<typename P::Storage>& scene,
                                    const LightLanes<typename P::Real>& light, Vec3<typename P::Real> receiver,
                                    const Uniform4& more, LightSample<typename P::Real>& sample) {
  using Real = typename P::Real;
  // The end of a segment towards an infinite light: outside of the bounding sphere for every receiver in it.
  const auto far = [&](Vec3<Real> direction)
                       WAVECREST_LAMBDA { return mulAdd(direction, Real(3 * scene.radius), receiver); };

  const Mask beam = isBeam(light.kind);
  if (any(beam)) {
    // e1 and e2 of a beam are axes of its picture, so the point that sampleLight took from them means nothing: a beam
    // is at p0. The formal density d^2 turns intensity into irradiance.
    const Vec3<Real> segment = light.p0 - receiver;
    const Real beamDist2 = length2(segment);
    const Real inverseDistance = reciprocalSqrt(max(beamDist2, Real(1e-37f)));
    sample.direction = select(beam, segment * inverseDistance, sample.direction);
    const Vec3<Real> factor = beamFactor<P, kFeatures>(scene, light, -sample.direction);
    sample.radiance = select(beam, light.radiance * factor, sample.radiance);
    sample.pdf = select(beam, beamDist2, sample.pdf);
    sample.emissionPdf = select(beam, beamPdfW(light, -dot(sample.direction, light.normal)), sample.emissionPdf);
    sample.end = select(beam, light.p0, sample.end);
    sample.delta = sample.delta | beam;
    sample.valid = select(beam, maxComponent(factor) > Real(0), sample.valid);
  }
  const Mask directional = light.kind == lightKind(LightKind::directional);
  if (any(directional)) {
    const Vec3<Real> direction = -light.normal;
    sample.direction = select(directional, direction, sample.direction);
    sample.pdf = select(directional, Real(1), sample.pdf);
    sample.emissionPdf = select(directional, reciprocal(projectedArea<Real>(scene, direction)), sample.emissionPdf);
    sample.end = select(directional, far(direction), sample.end);
    sample.delta = sample.delta | directional;
    sample.valid = sample.valid | directional;
  }
  const Mask map = light.kind == lightKind(LightKind::envmap);
  if (any(map)) {
    const Vec3<Real> direction = sampleMap<Real>(scene.environment, more);
    const MapPoint<Real> point = mapPoint(scene.environment, direction);
    const Real pdf = mapPdfW(scene.environment, point);
    sample.direction = select(map, direction, sample.direction);
    sample.radiance = select(map, mapRadiance(scene.environment, point), sample.radiance);
    sample.pdf = select(map, pdf, sample.pdf);
    sample.emissionPdf = select(map, pdf * reciprocal(projectedArea<Real>(scene, direction)), sample.emissionPdf);
    sample.end = select(map, far(direction), sample.end);
    sample.valid = select(map, pdf > Real(0), sample.valid);
  }
}

// A sample of the light `index` of each lane for a receiver. uniform.c and .d choose the place, while .a and .b have
// picked the light; more: four numbers for an environment map. The sample's densities are those of METHODS 2.2.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE LightSample<typename P::Real> sampleLight(const SceneView<typename P::Storage>& scene, UInt index,
                                                           Vec3<typename P::Real> receiver, const Uniform4& uniform,
                                                           [[maybe_unused]] const Uniform4& more) {
  using Real = typename P::Real;
  const LightLanes<Real> light = loadLight(scene, index);
  Real u = to<Real>(uniform.c), v = to<Real>(uniform.d);
  LightSample<Real> sample;
  sample.radiance = light.radiance;
  const Real pick = light.pick;

  // Quads and triangles: uniform over the area. Lanes of other lights get numbers that are replaced below.
  foldOntoTriangle(light.kind == lightKind(LightKind::triangle), u, v);
  Vec3<Real> point = mulAdd(light.e1, u, mulAdd(light.e2, v, light.p0));
  Vec3<Real> normal = light.normal;
  Real pdfA = light.inverseArea;

  // Spheres. cone: lanes that are sampled by solid angle.
  Mask cone = noLanes();
  Real coneHeight(1);
  if constexpr (has(kFeatures, kCurvedShapes)) {
    const Mask sphere = light.kind == lightKind(LightKind::sphere);
    if (any(sphere)) {
      Vec3<Real> spherePoint, sphereNormal;
      sampleSphere<P>(light, receiver, to<Real>(uniform.c), to<Real>(uniform.d), spherePoint, sphereNormal, coneHeight,
                      cone);
      cone = cone & sphere;
      point = select(sphere, spherePoint, point);
      normal = select(sphere, sphereNormal * light.e1.y, normal);  // inward where the sphere is turned inside out
    }
  }

  const Vec3<Real> segment = point - receiver;
  const Real dist2 = length2(segment);
  const Real inverseDistance = reciprocalSqrt(max(dist2, Real(1e-37f)));
  sample.direction = segment * inverseDistance;
  // Area lights: the density per area becomes one per solid angle at the receiver. A sample on a light that faces away
  // is not valid.
  const Real n0 = -dot(sample.direction, normal);
  sample.pdf = pdfA * dist2 * reciprocal(max(n0, Real(1e-12f)));
  sample.valid = n0 > Real(0);
  sample.emissionPdf = pdfA * Real(kInvPi);  // cosine-distributed around a uniform point
  sample.delta = noLanes();
  sample.end = mulAdd(normal, endOffset(light.offset, dist2 * inverseDistance), point);
  if constexpr (has(kFeatures, kCurvedShapes)) {
    sample.pdf = select(cone, Real(kInvPi / 2) * reciprocal(coneHeight), sample.pdf);
  }

  const Mask pointLike = light.kind == lightKind(LightKind::point);
  if (any(pointLike)) {  // d^2 turns intensity into irradiance
    sample.pdf = select(pointLike, dist2, sample.pdf);
    sample.delta = pointLike;
    sample.emissionPdf = select(pointLike, Real(kInvPi / 4), sample.emissionPdf);
    sample.valid = sample.valid | pointLike;
    sample.end = select(pointLike, point, sample.end);
  }
  const Mask constant = light.kind == lightKind(LightKind::constant);
  if (any(constant)) {
    const Vec3<Real> direction = uniformSphere<Real>(to<Real>(uniform.c), to<Real>(uniform.d));
    sample.direction = select(constant, direction, sample.direction);
    sample.pdf = select(constant, Real(kInvPi / 4), sample.pdf);
    sample.end = select(constant, mulAdd(direction, Real(3 * scene.radius), receiver), sample.end);
    sample.valid = sample.valid | constant;
    const Real emission = Real(kInvPi / 4) * reciprocal(projectedArea<Real>(scene, direction));
    sample.emissionPdf = select(constant, emission, sample.emissionPdf);
  }
  // Textures of area lights. Those of beams are part of beamFactor.
  if constexpr (has(kFeatures, kTextures)) {
    sample.radiance = sample.radiance *
                      to<Real>(textureFactor(scene.textures, scene.texels, light.texture, to<Float>(u), to<Float>(v)));
  }
  if constexpr (has(kFeatures, kRareLights)) addRareLights<P, kFeatures>(scene, light, receiver, more, sample);
  // Both densities include the choice of the light.
  sample.pdf = sample.pdf * pick;
  sample.emissionPdf = sample.emissionPdf * pick;
  return sample;
}

WAVECREST_SIMD_END
