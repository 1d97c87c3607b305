// arrive: from hits to vertices.
//
// in: Rays, Hits, PathStates [n]. out: Rays (origin moved to the vertex), Hits (primitive), Surfaces, PathStates [<= n]
// in the order of vertex_order_lanes.h, without paths that left the scene or may not go on; Radiance grows by emission
// found on the way.
//
// Per path: position and normal; the arrival step of the MIS recursion (METHODS 5.3, 5.4); on camera paths emission of
// strategy s = 0 with its weight (5.6), which needs the distance and cosine of this edge.
#include <cmath>

#include "kernels/endpoints/camera_lanes.h"
#include "kernels/endpoints/light_lanes.h"
#include "kernels/endpoints/scene_box_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/vertex_order_lanes.h"
#include "kernels/stage_declarations.h"
#include "kernels/surface/interpolation_lanes.h"
#include "kernels/surface/surface_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// Lanes whose rays show an infinite light if they meet it: with hide_emitters none that come from the camera. Walks of
// path space begin at any vertex of a path, and only a path of one edge is a view of the light.
template <class S>
WAVECREST_INLINE Mask showsInfinite(const StageContext<S>& context, UInt lane, Mask active) {
  if (!context.scene->hidesInfinite || context.depth > 1) return active;
  if (context.lanes.edges == nullptr) return noLanes();
  const UInt edges = gather(context.lanes.edges, select(active, lane, UInt(0u)));
  return andNot(active, edges == UInt(1u));
}

// Which lanes' emission counts.
template <class S>
struct EmissionRule {
  // Photon mapping: merging samples every path that has a vertex to merge at. Emission counts for paths of delta lobes
  // only. No other strategy samples these, so their MIS sums are 0.
  bool mergingAlone;
  const uint32_t* depths;  // of each lane the one at which emission counts, or null
  uint32_t depth;

  explicit EmissionRule(const StageContext<S>& context)
      : mergingAlone(context.mis.merge && !context.mis.nextEvent),
        depths(context.walk == Walk::camera ? context.lanes.emissionDepth : nullptr),
        depth(context.depth) {}
  template <class Real>
  WAVECREST_INLINE Mask counts(UInt lane, Mask active, const MisSums<Real>& mis) const {
    Mask counted = active;
    if (mergingAlone) counted = active & (mis.dVCM == Real(0)) & (mis.dVC == Real(0));
    if (depths != nullptr) counted = counted & (gather(depths, select(active, lane, UInt(0u))) == UInt(depth));
    return counted;
  }
};

// Adds the infinite light along lanes of block i that left the scene, weighted against the other strategies unless it
// stands alone. The sums are those before arrival: the light has no area measure.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE void addInfiniteLight(const StageContext<typename P::Storage>& context,
                                       Wave<typename P::Storage>& wave, size_t i, Mask missed,
                                       const MisSums<typename P::Real>& mis, bool alone) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& rays = wave.rays;
  const auto& paths = wave.paths;
  const UInt lane = load(paths.lane, i);
  missed = missed & showsInfinite(context, lane, missed);
  if (none(missed)) return;
  const Vec3<Real> direction = loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
  const auto& light = scene.lights[scene.infiniteLight];
  Vec3<Real> radiance{Real(light.radiance[0]), Real(light.radiance[1]), Real(light.radiance[2])};
  Real pdfW(kInvPi / 4);
  if constexpr (has(kFeatures, kRareLights)) {
    if (scene.environment.width != 0) {
      const MapPoint<Real> point = mapPoint(scene.environment, direction);
      radiance = mapRadiance(scene.environment, point);
      pdfW = mapPdfW(scene.environment, point);
    }
  }
  // Where there is no light its density may be 0, which an infinite sum turns into NaN.
  missed = missed & (maxComponent(abs(radiance)) > Real(0));
  if (none(missed)) return;
  if (!alone) {
    const Real pick(light.pick);
    Real wCamera(0);
    if (context.mis.nextEvent) wCamera = pick * pdfW * mis.dVCM;
    if constexpr (has(kFeatures, kBidirectional)) {
      wCamera = mulAdd(pick * pdfW * reciprocal(projectedArea<Real>(scene, direction)), mis.dVC, wCamera);
    }
    radiance = radiance * reciprocal(Real(1) + others(context.mis, wCamera));
  }
  const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
  addRadiance(wave.radiance, lane, missed, throughput * radiance);
}

// Adds the radiance of area lights that lanes of block i arrived at, weighted likewise with the sums after arrival
// (METHODS 5.6, s = 0). cosine: of the light's normal and the way back; dist2: squared length of the last edge.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE void addEmission(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                                  size_t i, Mask emits, UInt index, const SurfacePoint<typename P::Real>& surface,
                                  typename P::Real cosine, typename P::Real dist2, const MisSums<typename P::Real>& mis,
                                  bool alone) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& rays = wave.rays;
  const auto& paths = wave.paths;
  const LightLanes<Real> light = loadLight(scene, select(emits, index, UInt(0u)));
  Vec3<Real> radiance = light.radiance;
  if constexpr (has(kFeatures, kTextures)) {
    const Float u = to<Float>(surface.u), v = to<Float>(surface.v);
    radiance = radiance * to<Real>(textureFactor(scene.textures, scene.texels, light.texture, u, v));
  }
  // Lights without radiance are never picked: a density of 0, which an infinite sum turns into NaN.
  emits = emits & (maxComponent(abs(radiance)) > Real(0));
  if (none(emits)) return;
  if (!alone) {
    const Vec3<Real> receiver = loadVec3(rays.originX, rays.originY, rays.originZ, i);
    Real wCamera(0);
    if (context.mis.nextEvent) wCamera = directPdfA<P, kFeatures>(light, receiver, cosine, dist2) * mis.dVCM;
    if constexpr (has(kFeatures, kBidirectional)) {
      const Real emissionPdf = light.pick * light.inverseArea * cosine * Real(kInvPi);
      wCamera = mulAdd(emissionPdf, mis.dVC, wCamera);
    }
    radiance = radiance * reciprocal(Real(1) + others(context.mis, wCamera));
  }
  const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
  addRadiance(wave.radiance, load(paths.lane, i), emits, throughput * radiance);
}

// What turns dVCM of a light path's first edge into area measure at y_1: d^2 for a light that has a place. For spheres
// the density of next event estimation depends on the receiver and is only known here (METHODS 5.3).
template <class P, uint32_t kFeatures>
WAVECREST_INLINE typename P::Real firstLightEdge(const SceneView<typename P::Storage>& scene, UInt index,
                                                 Vec3<typename P::Real> origin, Vec3<typename P::Real> direction,
                                                 Vec3<typename P::Real> receiver, typename P::Real dist2) {
  using Real = typename P::Real;
  const LightLanes<Real> light = loadLight(scene, index);
  Real factor = dist2;
  const Mask infinite = isInfinite(light.kind);
  if (any(infinite)) factor = select(infinite, Real(1), factor);
  if constexpr (has(kFeatures, kCurvedShapes)) {
    const Mask sphere = light.kind == lightKind(LightKind::sphere);
    if (any(sphere)) {
      const Real r2 = light.radius * light.radius;
      const Real d2 = length2(light.p0 - receiver);
      const Mask outside = d2 > r2 * Real(kInsideSphere);
      const Real conePdf = Real(kInvPi / 2) * reciprocal(sphereConeHeight(r2, d2));
      // generateLightPaths put n_0 / emissionPdf into dVCM: times the direct density per solid angle this is directPdfA
      // d^2 over emissionPdf. That density is the cone's, or from inside the sphere d^2 / (area n_0).
      const Real n0 = abs(dot(origin - light.p0, direction)) * reciprocal(light.radius);
      const Real areaPdf = light.inverseArea * dist2 * reciprocal(max(n0, Real(1e-12f)));
      factor = select(sphere, select(outside, conePdf, areaPdf), factor);
    }
  }
  return factor;
}

// Lanes whose ray from the near clip meets its primitive before the far one. Not inlined: few scenes have a far clip.
template <class P, uint32_t kFeatures>
WAVECREST_NOINLINE Mask beforeFarClip(const SceneView<typename P::Storage>& scene, Mask hit, UInt primitive,
                                      Vec3<typename P::Real> origin, Vec3<typename P::Real> direction, const Hits& hits,
                                      size_t i) {
  using Real = typename P::Real;
  const InstanceLanes<P, kFeatures> instance(scene, hits, i, hit);
  const auto surface =
      instance.toWorld(surfacePoint<P, kFeatures>(scene, primitivesOf(scene, primitive), instance.pointToGroup(origin),
                                                  instance.vectorToGroup(direction), load(hits.u, i), load(hits.v, i)));
  return dot(surface.position - origin, broadcast<Real>(scene.camera.axis)) <=
         Real(scene.camera.farClip - scene.camera.nearClip);
}

// Densities of the MIS sums of block i, carried over the edge to the vertices at `position`, become those of area
// (METHODS 5.6). dist2: squared length of the edge; cosine: at its end.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE void toAreaMeasure(const StageContext<typename P::Storage>& context,
                                    const Wave<typename P::Storage>& wave, size_t i, Mask hit,
                                    Vec3<typename P::Real> position, typename P::Real dist2, typename P::Real cosine,
                                    MisSums<typename P::Real>& mis) {
  using Real = typename P::Real;
  const Real inverseCosine = reciprocal(max(abs(cosine), Real(1e-12f)));
  Real toArea = dist2;
  if constexpr (has(kFeatures, kBidirectional)) {
    const auto& scene = *context.scene;
    const auto& rays = wave.rays;
    if (context.depth == 1) {
      const Vec3<Real> direction = loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
      const Vec3<Real> origin = loadVec3(rays.originX, rays.originY, rays.originZ, i);
      if (context.walk == Walk::light) {
        const UInt from = select(hit, load(wave.paths.light, i), UInt(0u));
        toArea = firstLightEdge<P, kFeatures>(scene, from, origin, direction, position, dist2);
      } else if (scene.camera.nearClip > 0) {
        // The first edge of a camera path began at the near clip.
        toArea = length2(position - lensOf(scene.camera, origin, direction));
      } else if (scene.camera.parallel) {
        toArea = Real(1);
      }
    }
    mis.dVC = mis.dVC * inverseCosine;
  }
  mis.dVCM = mis.dVCM * toArea * inverseCosine;
}

// What the limit of edges ends: this many paths and this much of their beginnings' throughput.
template <class Real>
WAVECREST_NOINLINE void countCut(StageCounters& counters, Mask cut, Real throughput) {
  HWY_ALIGN typename Real::Storage carried[kLanes] = {};
  store(zeroUnless(cut, throughput), carried);
  counters.cutPaths += countTrue(cut);
  for (const auto value : carried) counters.cutThroughput += static_cast<double>(value);
}

}  // namespace

template <class P, uint32_t kFeatures>
void arrive(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& rays = wave.rays;
  const auto& paths = wave.paths;
  const bool camera = context.walk == Walk::camera;
  const EmissionRule<typename P::Storage> emission(context);
  const bool alone = context.depth == 1 || emission.mergingAlone;  // s = 0 is the only strategy of these paths
  const bool clipped = camera && context.depth == 1 && std::isfinite(scene.camera.farClip);
  const bool goesOn = context.depth + 1 <= context.limits.maxDepth;
  const size_t count = rays.size;
  VertexOrder<P, kFeatures> vertices(scene, wave);

  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt hitPrimitive = load(wave.hits.primitive, i);
    Mask hit = andNot(active, hitPrimitive == UInt(kMiss));
    const UInt primitive = select(hit, hitPrimitive, UInt(0u));
    const Vec3<Real> direction = loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
    const Vec3<Real> origin = loadVec3(rays.originX, rays.originY, rays.originZ, i);
    if (clipped) hit = hit & beforeFarClip<P, kFeatures>(scene, hit, primitive, origin, direction, wave.hits, i);
    const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    const UInt lane = load(paths.lane, i);
    MisSums<Real> mis = loadMis<kFeatures>(paths, i);

    // Rays that leave the scene: radiance of the sky or of another infinite light.
    const Mask counted = emission.counts(lane, active, mis);
    const Mask missed = andNot(active, hit);
    if (any(missed)) {
      context.counters->misses += countTrue(missed);
      if (camera && scene.infiniteLight != kNoIndex) {
        addInfiniteLight<P, kFeatures>(context, wave, i, missed & counted, mis, alone);
      }
      if (none(hit)) continue;
    }

    // The point of each hit, and the MIS sums carried over the edge to it.
    const auto at = primitivesOf(scene, primitive);
    const InstanceLanes<P, kFeatures> instance(scene, wave.hits, i, hit);
    const SurfacePoint<Real> inGroup =
        surfacePoint<P, kFeatures>(scene, at, instance.pointToGroup(origin), instance.vectorToGroup(direction),
                                   load(wave.hits.u, i), load(wave.hits.v, i));
    const SurfacePoint<Real> surface = instance.toWorld(inGroup);
    const Real dist2 = length2(surface.position - origin);
    const Real cosine = -dot(surface.normal, direction);
    toAreaMeasure<P, kFeatures>(context, wave, i, hit, surface.position, dist2, cosine, mis);

    VertexDetailLanes<Real> details(surface.normal);
    if constexpr (has(kFeatures, kShadingNormals | kTextures)) {
      details = interpolate<P, kFeatures>(scene, at, hit, inGroup, surface.normal, instance);
    }

    if (camera) {
      const UInt light = at(scene.primitives->light);
      const Mask emits = andNot(hit & counted & (cosine > Real(0)), light == UInt(kNoIndex));
      if (any(emits)) {
        addEmission<P, kFeatures>(context, wave, i, emits, light, surface, cosine, dist2, mis, alone);
      }
    }
    // The vertex goes into the wave, sorted by BSDF; paths at the limit of edges end here.
    Real rouletteScale(1);
    if constexpr (hasRouletteScale(kFeatures)) rouletteScale = load(paths.rouletteScale, i);
    if (!goesOn) {
      countCut(*context.counters, hit, maxComponent(abs(throughput)) * rouletteScale);
      continue;
    }
    vertices.append({.position = surface.position,
                     .direction = direction,
                     .normal = surface.normal,
                     .throughput = throughput,
                     .details = details,
                     .offset = surface.offset,
                     .rouletteScale = rouletteScale,
                     .mis = mis,
                     .lane = lane,
                     .primitive = primitive},
                    hit, at(scene.primitives->material));
  }
  vertices.finish();
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(arrive)
