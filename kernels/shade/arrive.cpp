// arrive: from hits to vertices.
//
// in: Rays, Hits, PathStates [n]. out: Rays (origin moved to the vertex), Hits (primitive), Surfaces, PathStates [<= n]
// in lane order, without paths that left the scene or may not go on; Radiance grows by emission found on the way.
//
// Per path: position and normal; the arrival step of the MIS recursion (METHODS 5.4); emission of strategy s = 0 with
// its weight (5.6), which needs the distance and cosine of this edge.
#include "kernels/shade/light_lanes.h"
#include "kernels/shade/surface_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Radiance of the infinite light along lanes that left the scene, weighted against next event estimation.
template <class P>
WAVECREST_INLINE Vec3<typename P::Real> missedRadiance(const SceneView<typename P::Storage>& scene,
                                                       typename P::Real dVCM, bool direct) {
  using Real = typename P::Real;
  const auto& light = scene.lights[scene.infiniteLight];
  Vec3<Real> radiance{Real(light.radiance[0]), Real(light.radiance[1]), Real(light.radiance[2])};
  if (direct) return radiance;
  // directPdfW = pick / (4 pi) for the constant environment; dVCM is 1 / pdfW of the BSDF's choice.
  const Real directPdfW = Real(light.pick) * Real(kInvPi / 4);
  return radiance * reciprocal<P>(Real(1) + directPdfW * dVCM);
}

}  // namespace

template <class P, uint32_t kFeatures>
void arrive(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  auto& rays = wave.rays;
  auto& paths = wave.paths;
  auto& surfaces = wave.surfaces;
  const bool direct = context.depth == 1;  // k = 1: only s = 0 makes this path
  const bool goesOn = context.depth + 1 <= context.limits.maxDepth;
  const size_t count = rays.size;
  size_t out = 0;
  uint64_t misses = 0;

  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt hitPrimitive = load(wave.hits.primitive, i);
    const Mask hit = andNot(active, hitPrimitive == UInt(kMiss));
    const UInt primitive = select(hit, hitPrimitive, UInt(0u));
    const Vec3<Real> direction = loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
    const Vec3<Real> origin = loadVec3(rays.originX, rays.originY, rays.originZ, i);
    const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    const UInt lane = load(paths.lane, i);
    Real dVCM = load(paths.dVCM, i);

    const Mask missed = andNot(active, hit);
    if (any(missed)) {
      misses += countTrue(missed);
      if (scene.infiniteLight != kNoIndex) {
        const Vec3<Real> radiance = throughput * missedRadiance<P>(scene, dVCM, direct);
        addRadiance(wave.radiance, lane, missed, radiance);
      }
      if (none(hit)) continue;
    }

    const RecordLanes<PrimitiveRecord<typename P::Storage>> at(scene.primitives, primitive);
    const SurfacePoint<Real> surface =
        surfacePoint<P, kFeatures>(scene, at, origin, direction, load(wave.hits.u, i), load(wave.hits.v, i));
    const Real dist2 = length2(surface.position - origin);
    const Real cosine = -dot(surface.normal, direction);
    dVCM = dVCM * dist2 * reciprocal<P>(max(abs(cosine), Real(1e-12f)));

    const UInt light = at(scene.primitives->light);
    const Mask emits = andNot(hit & (cosine > Real(0)), light == UInt(kNoIndex));
    if (any(emits)) {
      const RecordLanes<LightRecord<typename P::Storage>> lightAt(scene.lights, select(emits, light, UInt(0u)));
      Vec3<Real> radiance = throughput * lightAt(scene.lights->radiance);
      if (!direct) {
        const Real pdfA = directPdfA<P, kFeatures>(scene, lightAt, origin, cosine, dist2);
        radiance = radiance * reciprocal<P>(Real(1) + pdfA * dVCM);
      }
      addRadiance(wave.radiance, lane, emits, radiance);
    }
    if (!goesOn) continue;

    appendVec3(surface.position, hit, rays.originX, rays.originY, rays.originZ, out);
    appendVec3(direction, hit, rays.directionX, rays.directionY, rays.directionZ, out);
    appendVec3(surface.normal, hit, surfaces.normalX, surfaces.normalY, surfaces.normalZ, out);
    append(surface.offset, hit, surfaces.offset, out);
    appendVec3(throughput, hit, paths.throughputR, paths.throughputG, paths.throughputB, out);
    append(dVCM, hit, paths.dVCM, out);
    append(lane, hit, paths.lane, out);
    append(primitive, hit, wave.hits.primitive, out);
    if constexpr (has(kFeatures, kSpecularBsdfs)) {
      append(load(paths.etaScale, i), hit, paths.etaScale, out);
    }
    out += countTrue(hit);
  }
  context.counters->misses += misses;
  rays.size = paths.size = wave.hits.size = surfaces.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(arrive)
