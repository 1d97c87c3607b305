// generate: starts one light path per lane of the wave.
//
// in: path indices [firstPath, firstPath + pathCount), or the context's lanes [pathCount]. out: Rays, PathStates
// [pathCount], in lane order. Sampling of emission after METHODS 2.2: a point on the light by area and a direction by
// cosine; for infinite lights a direction and a point on the disc that faces it and covers the scene. MIS sums of the
// origin: METHODS 5.3.
#include "kernels/connect/light_sample_lanes.h"
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
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromPoint(const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                            const LightRecord<typename P::Storage>& fields,
                                                            const Uniform4& u) {
  using Real = typename P::Real;
  const Vec3<Real> direction = uniformSphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Real inverse = reciprocal<P>(at(fields.pick)) * Real(4 * kPi);
  return {at(fields.p0), direction, at(fields.radiance) * inverse, {Real(4 * kPi), Real(0), Real(0)}};
}

// Origin of a ray that comes from outside the scene: on the disc of the bounding sphere that faces the direction.
template <class P>
WAVECREST_INLINE Vec3<typename P::Real> pointOnDisc(const SceneView<typename P::Storage>& scene,
                                                    Vec3<typename P::Real> direction, const Uniform4& v) {
  using Real = typename P::Real;
  const Vec2<Real> disc = concentricDisc<Real>(to<Real>(v.a), to<Real>(v.b));
  const Real radius(scene.radius);
  return broadcast<Real>(scene.center) +
         Frame<Real>::fromNormal(direction).toWorld({disc.x * radius, disc.y * radius, -radius});
}

// The constant environment: from the disc of the bounding sphere, against the direction to the light.
template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromConstant(const SceneView<typename P::Storage>& scene,
                                                               const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                               const Uniform4& u, const Uniform4& v) {
  using Real = typename P::Real;
  const Vec3<Real> direction = uniformSphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Real inversePick = reciprocal<P>(at(scene.lights->pick));
  const Real discArea(kPi * scene.radius * scene.radius);
  const Real inverseEmission = inversePick * discArea * Real(4 * kPi);
  return {pointOnDisc<P>(scene, direction, v),
          direction,
          at(scene.lights->radiance) * inverseEmission,
          {discArea, inverseEmission, Real(0)}};
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromArea(const SceneView<typename P::Storage>& scene,
                                                           const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                           UInt kind, const Uniform4& u, const Uniform4& v) {
  using Real = typename P::Real;
  const auto& fields = *scene.lights;
  Real a = to<Real>(v.a), b = to<Real>(v.b);
  const Mask fold = (kind == lightKind(LightKind::triangle)) & (a + b > Real(1));
  a = select(fold, Real(1) - a, a);
  b = select(fold, Real(1) - b, b);
  Vec3<Real> point = mulAdd(at(fields.e1), a, mulAdd(at(fields.e2), b, at(fields.p0)));
  Vec3<Real> normal = at(fields.normal);
  Mask sphere = noLanes();
  if constexpr (has(kFeatures, kCurvedShapes)) {
    sphere = kind == lightKind(LightKind::sphere);
    if (any(sphere)) {
      const Vec3<Real> outward = uniformSphere<Real>(to<Real>(v.a), to<Real>(v.b));
      normal = select(sphere, outward * at(fields.e1).y, normal);
      point = select(sphere, mulAdd(outward, at(fields.radius), at(fields.p0)), point);
    }
  }
  const Vec3<Real> local = cosineHemisphere<Real>(to<Real>(u.b), to<Real>(u.c));
  const Vec3<Real> direction = Frame<Real>::fromNormal(normal).toWorld(local);
  const Real area = reciprocal<P>(at(fields.inverseArea));
  const Real inversePick = reciprocal<P>(at(fields.pick));
  const Real flux = Real(kPi) * area * inversePick;
  // directPdf / emissionPdf = (1 / area) / (n_0 / (pi area)). A sphere's direct density depends on the receiver: arrive
  // supplies it, and here stands pick n_0 / emissionPdf = pi area.
  const Real dVCM = select(sphere, Real(kPi) * area, Real(kPi) * reciprocal<P>(local.z));
  Vec3<Real> radiance = at(fields.radiance);
  if constexpr (has(kFeatures, kTextures)) {
    radiance = radiance *
               to<Real>(textureFactor(scene.textures, scene.texels, at(fields.texture), to<Float>(a), to<Float>(b)));
  }
  return {mulAdd(normal, at(fields.offset), point), direction, radiance * flux, {dVCM, flux, Real(0)}};
}

template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromSpot(const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                           const LightRecord<typename P::Storage>& fields,
                                                           const Uniform4& u) {
  using Real = typename P::Real;
  const Real cosTotal = at(fields.cosTotal);
  const Real height = max(Real(1) - cosTotal, Real(1e-9f));
  const Vec3<Real> local = uniformCone<Real>(to<Real>(u.b), to<Real>(u.c), height);
  const Real inverseCone = Real(2 * kPi) * height;
  const Real falloff = spotFalloff(local.z, cosTotal, at(fields.cosFalloff));
  return {at(fields.p0),
          Frame<Real>::fromNormal(at(fields.normal)).toWorld(local),
          at(fields.radiance) * (falloff * inverseCone * reciprocal<P>(at(fields.pick))),
          {inverseCone, Real(0), Real(0)}};
}

template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitDirectional(const SceneView<typename P::Storage>& scene,
                                                              const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                              const Uniform4& v) {
  using Real = typename P::Real;
  const Vec3<Real> direction = at(scene.lights->normal);
  const Real discArea(kPi * scene.radius * scene.radius);
  return {pointOnDisc<P>(scene, direction, v),
          direction,
          at(scene.lights->radiance) * (discArea * reciprocal<P>(at(scene.lights->pick))),
          {discArea, Real(0), Real(0)}};
}

template <class P>
WAVECREST_INLINE EmittedRay<typename P::Real> emitFromMap(const SceneView<typename P::Storage>& scene,
                                                          const RecordLanes<LightRecord<typename P::Storage>>& at,
                                                          const Uniform4& v, const Uniform4& more) {
  using Real = typename P::Real;
  const Vec3<Real> toLight = sampleMap<Real>(scene.environment, more);
  const MapPoint<Real> point = mapPoint(scene.environment, toLight);
  const Real discArea(kPi * scene.radius * scene.radius);
  const Real inverseEmission =
      discArea / (max(mapPdfW(scene.environment, point), Real(1e-30f)) * at(scene.lights->pick));
  return {pointOnDisc<P>(scene, -toLight, v),
          -toLight,
          mapRadiance(scene.environment, point) * inverseEmission,
          {discArea, inverseEmission, Real(0)}};
}

template <class Real>
WAVECREST_INLINE EmittedRay<Real> select(Mask m, const EmittedRay<Real>& yes, const EmittedRay<Real>& no) {
  return {select(m, yes.origin, no.origin),
          select(m, yes.direction, no.direction),
          select(m, yes.throughput, no.throughput),
          {select(m, yes.mis.dVCM, no.mis.dVCM), select(m, yes.mis.dVC, no.mis.dVC), Real(0)}};
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
    UInt lane = laneIndex(static_cast<uint32_t>(i));
    if (context.lanes != nullptr) lane = load(context.lanes + i);
    const UInt path = pathOf(context, wave, lane);
    const Uniform4 u = draw(context, path, Block::scatter), v = draw(context, path, Block::light);
    const UInt light = pickLight(scene, u.a, u.d);
    const RecordLanes<LightRecord<typename P::Storage>> at(scene.lights, light);
    const UInt kind = at(scene.lights->kind);

    EmittedRay<Real> ray = emitFromArea<P, kFeatures>(scene, at, kind, u, v);
    const Mask point = kind == lightKind(LightKind::point);
    if (any(point)) ray = select(point, emitFromPoint<P>(at, *scene.lights, u), ray);
    const Mask constant = kind == lightKind(LightKind::constant);
    if (any(constant)) ray = select(constant, emitFromConstant<P>(scene, at, u, v), ray);

    if constexpr (has(kFeatures, kRareLights)) {
      const Mask spot = kind == lightKind(LightKind::spot);
      if (any(spot)) ray = select(spot, emitFromSpot<P>(at, *scene.lights, u), ray);
      const Mask directional = kind == lightKind(LightKind::directional);
      if (any(directional)) ray = select(directional, emitDirectional<P>(scene, at, v), ray);
      const Mask map = kind == lightKind(LightKind::envmap);
      if (any(map)) ray = select(map, emitFromMap<P>(scene, at, v, draw(context, path, Block::environment)), ray);
    }

    const Real zero(0);
    if (!context.mis.nextEvent) ray.mis.dVCM = zero;
    if (!context.mis.emission) ray.mis.dVC = zero;
    ray.mis.dVM = ray.mis.dVC * Real(context.mis.kVC);
    storeVec3(ray.origin, rays.originX, rays.originY, rays.originZ, i);
    storeVec3(ray.direction, rays.directionX, rays.directionY, rays.directionZ, i);
    storeVec3(ray.throughput, paths.throughputR, paths.throughputG, paths.throughputB, i);
    storeMis<kFeatures>(ray.mis, paths, i);
    store(Real(1) / max(maxComponent(ray.throughput), Real(1e-30f)), paths.rouletteScale, i);
    store(lane, paths.lane, i);
    store(light, paths.light, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(generateLightPaths)
