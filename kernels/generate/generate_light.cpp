// generate: starts one light path per lane of the wave.
//
// in: path indices [firstPath, firstPath + pathCount), or the context's lanes [pathCount]. out: Rays, PathStates
// [pathCount], in lane order. Sampling of emission after METHODS 2.2: a point on the light by area and a direction by
// cosine; for infinite lights a direction and a point on the faces of the scene's box that it enters by. MIS sums of
// the origin: METHODS 5.3.
#include "kernels/endpoints/light_lanes.h"
#include "kernels/endpoints/light_sample_lanes.h"
#include "kernels/endpoints/scene_box_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

template <class Real>
struct EmittedRay {
  Vec3<Real> origin, direction;
  Vec3<Real> throughput;  // L n_0 / (pick pdf)
  MisSums<Real> mis;      // dVCM: direct density over emission density, in the measure of y_0, before the first edge
};

// Point lights: uniform over the sphere of directions.
template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromPoint(const LightLanes<typename P::Real>& light,
                                                            const Uniform4& u) {
  using Real = typename P::Real;
  const Vec3<Real> direction = uniformSphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Real inverse = reciprocal(light.pick) * Real(4 * kPi);
  return {light.p0, direction, light.radiance * inverse, {Real(4 * kPi), Real(0)}};
}

// Origin of a ray that comes from outside the scene.
template <class P>
WAVECREST_INLINE Vec3<typename P::Real> pointOfEntry(const SceneView<typename P::Storage>& scene,
                                                     Vec3<typename P::Real> direction, const Uniform4& v) {
  using Real = typename P::Real;
  return pointOnBox<Real>(scene, direction, to<Real>(v.a), to<Real>(v.b), to<Real>(v.c));
}

// The constant environment: any direction is as likely.
template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromConstant(const SceneView<typename P::Storage>& scene,
                                                               const LightLanes<typename P::Real>& light,
                                                               const Uniform4& u, const Uniform4& v) {
  using Real = typename P::Real;
  const Vec3<Real> direction = uniformSphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Real inversePick = reciprocal(light.pick);
  const Real area = projectedArea<Real>(scene, direction);
  const Real inverseEmission = inversePick * area * Real(4 * kPi);
  return {pointOfEntry<P>(scene, direction, v), direction, light.radiance * inverseEmission, {area, inverseEmission}};
}

// Quads, triangles and spheres: uniform over the area, then cosine-distributed around the normal there. Lanes of other
// lights get numbers that the caller replaces.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromArea(const SceneView<typename P::Storage>& scene,
                                                           const LightLanes<typename P::Real>& light, const Uniform4& u,
                                                           const Uniform4& v) {
  using Real = typename P::Real;
  Real a = to<Real>(v.a), b = to<Real>(v.b);
  foldOntoTriangle(light.kind == lightKind(LightKind::triangle), a, b);
  Vec3<Real> point = mulAdd(light.e1, a, mulAdd(light.e2, b, light.p0));
  Vec3<Real> normal = light.normal;
  Mask sphere = noLanes();
  if constexpr (has(kFeatures, kCurvedShapes)) {
    sphere = light.kind == lightKind(LightKind::sphere);
    if (any(sphere)) {
      const Vec3<Real> outward = uniformSphere<Real>(to<Real>(v.a), to<Real>(v.b));
      normal = select(sphere, outward * light.e1.y, normal);
      point = select(sphere, mulAdd(outward, light.radius, light.p0), point);
    }
  }
  // The flux pi A L / pick is the throughput: n_0 cancels against the density of the direction.
  const Vec3<Real> local = cosineHemisphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Vec3<Real> direction = Frame<Real>::fromNormal(normal).toWorld(local);
  const Real area = reciprocal(light.inverseArea);
  const Real inversePick = reciprocal(light.pick);
  const Real flux = Real(kPi) * area * inversePick;
  // directPdf / emissionPdf = (1 / area) / (n_0 / (pi area)). A sphere's direct density depends on the receiver: arrive
  // supplies it, and here stands pick n_0 / emissionPdf = pi area.
  const Real dVCM = select(sphere, Real(kPi) * area, Real(kPi) * reciprocal(local.z));
  Vec3<Real> radiance = light.radiance;
  if constexpr (has(kFeatures, kTextures)) {
    radiance =
        radiance * to<Real>(textureFactor(scene.textures, scene.texels, light.texture, to<Float>(a), to<Float>(b)));
  }
  return {mulAdd(normal, light.offset, point), direction, radiance * flux, {dVCM, flux}};
}

// Spot lights: uniform in the cone. Projectors: uniform on the picture.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromBeam(const SceneView<typename P::Storage>& scene,
                                                           const LightLanes<typename P::Real>& light,
                                                           const Uniform4& u) {
  using Real = typename P::Real;
  const Real one(1), two(2), b = to<Real>(u.b), c = to<Real>(u.c);
  Vec3<Real> direction = Frame<Real>::fromNormal(light.normal).toWorld(uniformCone<Real>(b, c, light.cutoffHeight));
  const Mask projector = light.kind == lightKind(LightKind::projector);
  if (any(projector)) {
    // From a place in [0, 1] to a vector in the picture's plane from its middle, whose product with the axis is between
    // -1 and 1.
    const auto edge = [&](Vec3<Real> axis, Real place) WAVECREST_LAMBDA {
      return axis * (mulAdd(place, two, -one) / max(length2(axis), Real(1e-30f)));
    };
    direction = select(projector, normalize(light.normal + edge(light.e1, b) + edge(light.e2, c)), direction);
  }
  const Real inversePdf = one / beamPdfW(light, dot(direction, light.normal));
  return {light.p0,
          direction,
          light.radiance * beamFactor<P, kFeatures>(scene, light, direction) * (inversePdf * reciprocal(light.pick)),
          {inversePdf, Real(0)}};
}

// Directional lights: the direction is given, only the point of entry is sampled.
template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitDirectional(const SceneView<typename P::Storage>& scene,
                                                              const LightLanes<typename P::Real>& light,
                                                              const Uniform4& v) {
  using Real = typename P::Real;
  const Vec3<Real> direction = light.normal;
  const Real area = projectedArea<Real>(scene, direction);
  return {pointOfEntry<P>(scene, direction, v),
          direction,
          light.radiance * (area * reciprocal(light.pick)),
          {area, Real(0)}};
}

// Environment maps: the direction that next event estimation would sample, reversed. more: its four numbers.
template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromMap(const SceneView<typename P::Storage>& scene,
                                                          const LightLanes<typename P::Real>& light, const Uniform4& v,
                                                          const Uniform4& more) {
  using Real = typename P::Real;
  const Vec3<Real> toLight = sampleMap<Real>(scene.environment, more);
  const MapPoint<Real> point = mapPoint(scene.environment, toLight);
  const Real area = projectedArea<Real>(scene, toLight);
  // Where rounding has led to a density of 0 there is no light.
  const Real pdf = mapPdfW(scene.environment, point);
  const Real inverseEmission = zeroUnless(pdf > Real(0), area / (pdf * light.pick));
  return {pointOfEntry<P>(scene, -toLight, v),
          -toLight,
          mapRadiance(scene.environment, point) * inverseEmission,
          {area, inverseEmission}};
}

template <class Real>
WAVECREST_INLINE EmittedRay<Real> select(Mask m, const EmittedRay<Real>& yes, const EmittedRay<Real>& no) {
  return {select(m, yes.origin, no.origin),
          select(m, yes.direction, no.direction),
          select(m, yes.throughput, no.throughput),
          {select(m, yes.mis.dVCM, no.mis.dVCM), select(m, yes.mis.dVC, no.mis.dVC)}};
}

}  // namespace

template <class P, uint32_t kFeatures>
void generateLightPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  auto& rays = wave.rays;
  auto& paths = wave.paths;
  const size_t count = scene.lightCount == 0 ? 0 : wave.pathCount;
  rays.size = paths.size = 0;
  rays.claim(count);
  paths.claim(count);

  for (size_t i = 0; i < count; i += kLanes) {
    // Choose a light.
    UInt lane = laneIndex(static_cast<uint32_t>(i));
    if (context.lanes.lightPaths != nullptr) lane = load(context.lanes.lightPaths + i);
    const UInt path = pathOf(context, wave, lane);
    const Uniform4 u = draw(context, path, Block::scatter), v = draw(context, path, Block::light);
    const UInt picked = pickLight(scene, u.a, u.d);
    const LightLanes<Real> light = loadLight(scene, picked);

    // Sample its emission, by each kind that some lane has.
    EmittedRay<Real> ray = emitFromArea<P, kFeatures>(scene, light, u, v);
    const Mask point = light.kind == lightKind(LightKind::point);
    if (any(point)) ray = select(point, emitFromPoint<P>(light, u), ray);
    const Mask constant = light.kind == lightKind(LightKind::constant);
    if (any(constant)) ray = select(constant, emitFromConstant<P>(scene, light, u, v), ray);

    if constexpr (has(kFeatures, kRareLights)) {
      const Mask beam = isBeam(light.kind);
      if (any(beam)) ray = select(beam, emitFromBeam<P, kFeatures>(scene, light, u), ray);
      const Mask directional = light.kind == lightKind(LightKind::directional);
      if (any(directional)) ray = select(directional, emitDirectional<P>(scene, light, v), ray);
      const Mask map = light.kind == lightKind(LightKind::envmap);
      if (any(map)) ray = select(map, emitFromMap<P>(scene, light, v, draw(context, path, Block::environment)), ray);
    }

    // Strategies that are switched off put 0 into the sums (METHODS 5.3).
    const Real zero(0);
    if (!context.mis.nextEvent) ray.mis.dVCM = zero;
    if (!context.mis.emission) ray.mis.dVC = zero;
    storeVec3(ray.origin, rays.originX, rays.originY, rays.originZ, i);
    storeVec3(ray.direction, rays.directionX, rays.directionY, rays.directionZ, i);
    storeVec3(ray.throughput, paths.throughputR, paths.throughputG, paths.throughputB, i);
    storeMis<kFeatures>(ray.mis, paths, i);
    // Russian roulette compares throughputs with the first one (METHODS 1.5). The bound keeps its reciprocal finite.
    store(Real(1) / max(maxComponent(abs(ray.throughput)), Real(1e-37f)), paths.rouletteScale, i);
    store(lane, paths.lane, i);
    store(picked, paths.light, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(generateLightPaths)
