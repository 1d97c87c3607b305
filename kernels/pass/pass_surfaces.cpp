// extendPassing, occludePassing: what extend and occlude do in scenes with surfaces that let light straight on
// (METHODS 3.10). Both are made of the scene's own extend and occlude, whatever its intersector.
//
// extendPassing - in: Rays, PathStates [n]. out: Hits [n], of the surface at which each walk stops. A walk passes a
// surface with the probability that its passage leaves; then its throughput takes the passage's tint, and dVCM the
// probability. The ray keeps its origin, so an edge and its densities are those between the two vertices.
//
// occludePassing - in: ShadowRays [n]. out: as occlude. A contribution is multiplied by the colours of all passages on
// its way, and its weight takes their probability: what other strategies have in the weight's denominator are walks
// along the same edge, which must pass as well.
#include <cmath>
#include <utility>

#include "kernels/bsdf/passage_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/mutate/path_law.h"
#include "kernels/sampling/chain_lanes.h"
#include "kernels/stage_declarations.h"
#include "kernels/surface/interpolation_lanes.h"
#include "kernels/surface/surface_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// No scene has so many surfaces in a row. Ends the loops should a ray meet one again and again.
constexpr size_t kMostPassages = 1u << 12;

// The surface that each ray of a block has met.
template <class P>
struct MetSurface {
  using Real = typename P::Real;
  Mask passes;  // its material lets light through; the rest is set where some lane of the block has such a material
  Passage<Real> passage;
  Vec3<Real> position, normal;
  Real offset;
};

template <class P>
WAVECREST_NOINLINE MetSurface<P> surfaceMet(const SceneView<typename P::Storage>& scene,
                                            const Rays<typename P::Storage>& rays, const Hits& hits, size_t i,
                                            Mask active) {
  const UInt primitive = load(hits.primitive, i);
  const Mask hit = andNot(active, primitive == UInt(kMiss));
  const auto at = primitivesOf(scene, select(hit, primitive, UInt(0u)));
  const UInt material = at(scene.primitives->material);
  MetSurface<P> met;
  met.passes = hit & passesLight(scene, material);
  if (none(met.passes)) return met;
  const InstanceLanes<P, kAllFeatures> instance(scene, hits, i, hit);
  const auto origin = loadVec3(rays.originX, rays.originY, rays.originZ, i);
  const auto direction = loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
  const auto inGroup = surfacePoint<P, kAllFeatures>(
      scene, at, instance.pointToGroup(origin), instance.vectorToGroup(direction), load(hits.u, i), load(hits.v, i));
  const auto surface = instance.toWorld(inGroup);
  const auto details = interpolate<P, kAllFeatures>(scene, at, met.passes, inGroup, surface.normal, instance);
  met.passage = passageOf<P>(scene, material, met.passes, details.u, details.v);
  met.position = surface.position;
  met.normal = surface.normal;
  met.offset = surface.offset;
  return met;
}

// Whether each walk meets its surface within the camera's far clip. What lies beyond is not seen, so nothing passes it:
// the walk stops there, and arrive counts it as a miss. Parallel rays begin where the clip is measured from.
template <class P>
WAVECREST_INLINE Mask withinFarClip(const CameraView& camera, const MetSurface<P>& met) {
  using Real = typename P::Real;
  const Vec3<Real> fromCamera = met.position - broadcast<Real>(camera.origin);
  return dot(fromCamera, broadcast<Real>(camera.axis)) <= Real(camera.farClip);
}

// Rays that go on, to wave.passing from `out` on; where they end.
template <class P>
WAVECREST_INLINE size_t goOn(const MetSurface<P>& met, Mask m, Vec3<typename P::Real> direction, UInt index,
                             Float number, PassingRays<typename P::Storage>& passing, size_t out) {
  auto& rays = passing.rays;
  appendVec3(offsetOrigin(met.position, met.normal, met.offset, direction), m, rays.originX, rays.originY, rays.originZ,
             out);
  appendVec3(direction, m, rays.directionX, rays.directionY, rays.directionZ, out);
  append(index, m, passing.marks.index, out);
  append(number, m, passing.marks.number, out);
  return out + countTrue(m);
}

// The closest hits of the first `count` rays of wave.passing.
template <class S>
void tracePassing(const StageContext<S>& context, Wave<S>& wave, size_t count) {
  auto& passing = wave.passing;
  passing.rays.size = count;
  std::swap(wave.rays, passing.rays);
  std::swap(wave.hits, passing.hits);
  context.scene->closestHits(context, wave);
  std::swap(wave.rays, passing.rays);
  std::swap(wave.hits, passing.hits);
}

// ---- walks ----------------------------------------------------------------------------------------------------------

// The number that decides which surfaces the edge to this vertex passes. Chains draw it anew in every step: a proposal
// then replaces it by an independent one, which leaves the distribution of chains as it is.
template <class S>
WAVECREST_INLINE Float passageNumbers(const StageContext<S>& context, const Wave<S>& wave, UInt lane) {
  if (context.sampler.kind != SamplerKind::chain) {
    return draw(context, pathOf(context, wave, lane), Block::opacity).a;
  }
  const uint32_t block = 4 * context.depth + static_cast<uint32_t>(Block::opacity);
  const ChainUse use = context.walk == Walk::light ? ChainUse::lightWalk : ChainUse::cameraWalk;
  return toUnitInterval(chainBits(context.sampler, gather(context.sampler.chain->source, lane), block, use).a);
}

// Of the rays of a block, those that pass the surface they met go on; index: in the wave. number: below 1 - stop where
// a walk passes; what is left of it decides about the next surface.
template <class P>
WAVECREST_INLINE size_t passOn(const MetSurface<P>& met, Vec3<typename P::Real> direction, UInt index, Float number,
                               Wave<typename P::Storage>& wave, size_t out) {
  using Real = typename P::Real;
  const Real pass = Real(1) - met.passage.stop;
  const Mask m = met.passes & (to<Real>(number) < pass);
  if (none(m)) return out;
  const Real inverse = reciprocal(select(m, pass, Real(1)));
  auto& paths = wave.paths;
  const UInt at = select(m, index, UInt(0u));
  const Vec3<Real> throughput = gatherVec3(paths.throughputR, paths.throughputG, paths.throughputB, at);
  storeWhere(throughput * met.passage.colour * inverse, m, paths.throughputR, paths.throughputG, paths.throughputB, at);
  storeWhere(gather(paths.dVCM, at) * inverse, m, paths.dVCM, at);
  const Float rest = min(number * to<Float>(inverse), Float(0x1.fffffep-1f));
  return goOn(met, m, direction, index, rest, wave.passing, out);
}

// The hits of block i of wave.passing become those of the wave's rays.
template <class P>
WAVECREST_INLINE void keepHits(const SceneView<typename P::Storage>& scene, Mask active, UInt index,
                               Wave<typename P::Storage>& wave, size_t i) {
  using Real = typename P::Real;
  const auto& from = wave.passing;
  const UInt primitive = load(from.hits.primitive, i);
  Float u = load(from.hits.u, i);
  if (scene.spheres) {
    // u of a sphere is the distance from the ray's origin.
    const Mask hit = andNot(active, primitive == UInt(kMiss));
    const auto at = primitivesOf(scene, select(hit, primitive, UInt(0u)));
    const Mask sphere = hit & (at(scene.primitives->kind) == UInt(static_cast<uint32_t>(PrimitiveKind::sphere)));
    const UInt back = select(active, index, UInt(0u));
    const Vec3<Real> before = loadVec3(from.rays.originX, from.rays.originY, from.rays.originZ, i) -
                              gatherVec3(wave.rays.originX, wave.rays.originY, wave.rays.originZ, back);
    const Vec3<Real> direction = loadVec3(from.rays.directionX, from.rays.directionY, from.rays.directionZ, i);
    u = select(sphere, u + to<Float>(dot(before, direction)), u);
  }
  storeWhere(primitive, active, wave.hits.primitive, index);
  storeWhere(u, active, wave.hits.u, index);
  storeWhere(load(from.hits.v, i), active, wave.hits.v, index);
  if (scene.instances != nullptr) storeWhere(load(from.hits.instance, i), active, wave.hits.instance, index);
}

// ---- shadow rays ----------------------------------------------------------------------------------------------------

// Shadow rays of a block that pass the surface they met: the contribution is taken on, and the segment begins behind.
template <class P>
WAVECREST_INLINE size_t passLight(const StageContext<typename P::Storage>& context, const MetSurface<P>& met,
                                  Vec3<typename P::Real> direction, UInt index, Float number,
                                  Wave<typename P::Storage>& wave, size_t out) {
  using Real = typename P::Real;
  auto& shadow = wave.shadowRays;
  const Real zero(0), one(1);
  const UInt at = select(met.passes, index, UInt(0u));
  const Vec3<Float> origin = gatherVec3(shadow.originX, shadow.originY, shadow.originZ, at);
  const Vec3<Float> end = origin + gatherVec3(shadow.directionX, shadow.directionY, shadow.directionZ, at);
  // The surface lies between both ends: the segment ends off its own surface, on this side of it.
  const Mask between =
      met.passes & ((dot(to<Real>(end) - met.position, met.normal) * dot(direction, met.normal)) > zero);
  const Real pass = one - met.passage.stop;
  Mask m = between & (pass > zero) & (maxComponent(met.passage.colour) > zero);
  const bool decides = context.chains.paths != nullptr;  // paths of chains are visible or not
  if (decides) m = m & (to<Real>(number) < pass);
  if (none(m)) return out;

  if (decides) {
    number = min(number / to<Float>(select(m, pass, one)), Float(0x1.fffffep-1f));
  } else {
    // The weight 1 / (1 + others) is in the contribution.
    const Real before = gather(shadow.others, at), left = before * pass;
    const Real reweighted = (one + others(context.mis, before)) / (one + others(context.mis, left));
    const Vec3<Real> contribution = gatherVec3(shadow.red, shadow.green, shadow.blue, at);
    storeWhere(contribution * met.passage.colour * reweighted, m, shadow.red, shadow.green, shadow.blue, at);
    storeWhere(left, m, shadow.others, at);
  }
  const Vec3<Float> begin = to<Float>(offsetOrigin(met.position, met.normal, met.offset, direction));
  storeWhere(begin, m, shadow.originX, shadow.originY, shadow.originZ, at);
  storeWhere(end - begin, m, shadow.directionX, shadow.directionY, shadow.directionZ, at);
  return goOn(met, m, direction, index, number, wave.passing, out);
}

// All shadow rays as rays with unit directions.
template <class P>
size_t beginShadows(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  auto& shadow = wave.shadowRays;
  auto& passing = wave.passing;
  for (size_t i = 0; i < shadow.size; i += kLanes) {
    const Mask active = firstLanes(shadow.size - i);
    const Vec3<Real> segment = to<Real>(loadVec3(shadow.directionX, shadow.directionY, shadow.directionZ, i));
    const Vec3<Real> direction = segment * reciprocalSqrt(max(length2(segment), Real(1e-37f)));
    storeVec3(to<Real>(loadVec3(shadow.originX, shadow.originY, shadow.originZ, i)), passing.rays.originX,
              passing.rays.originY, passing.rays.originZ, i);
    storeVec3(direction, passing.rays.directionX, passing.rays.directionY, passing.rays.directionZ, i);
    store(laneIndex(static_cast<uint32_t>(i)), passing.marks.index, i);
    Float number(0);
    if (context.chains.paths != nullptr) {
      const UInt lane = select(active, load(shadow.target, i), UInt(0u));
      number = toUnitInterval(
          chainBits(context.sampler, gather(context.sampler.chain->source, lane), kPassageBlock, ChainUse::step).a);
    }
    store(number, passing.marks.number, i);
  }
  return shadow.size;
}

}  // namespace

template <class P>
void extendPassing(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const auto& scene = *context.scene;
  auto& passing = wave.passing;
  const bool clipped = context.walk == Walk::camera && context.depth == 1 && std::isfinite(scene.camera.farClip);
  scene.closestHits(context, wave);
  // Which rays pass the surface that they met.
  size_t count = 0;
  for (size_t i = 0; i < wave.rays.size; i += kLanes) {
    const Mask active = firstLanes(wave.rays.size - i);
    auto met = surfaceMet<P>(scene, wave.rays, wave.hits, i, active);
    if (none(met.passes)) continue;
    if (clipped) met.passes = met.passes & withinFarClip(scene.camera, met);
    const UInt lane = select(met.passes, load(wave.paths.lane, i), UInt(0u));
    const auto direction = loadVec3(wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i);
    count =
        passOn(met, direction, laneIndex(static_cast<uint32_t>(i)), passageNumbers(context, wave, lane), wave, count);
  }
  // Trace those on, until each has met a surface that it stops at, or nothing.
  for (size_t round = 0; count != 0 && round < kMostPassages; ++round) {
    tracePassing(context, wave, count);
    size_t out = 0;
    for (size_t i = 0; i < count; i += kLanes) {
      const Mask active = firstLanes(count - i);
      const UInt index = load(passing.marks.index, i);
      const Float number = load(passing.marks.number, i);
      auto met = surfaceMet<P>(scene, passing.rays, passing.hits, i, active);
      keepHits<P>(scene, active, index, wave, i);
      if (none(met.passes)) continue;
      if (clipped) met.passes = met.passes & withinFarClip(scene.camera, met);
      const auto direction = loadVec3(passing.rays.directionX, passing.rays.directionY, passing.rays.directionZ, i);
      out = passOn(met, direction, index, number, wave, out);
    }
    count = out;
  }
}

template <class P>
void occludePassing(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const auto& scene = *context.scene;
  auto& passing = wave.passing;
  size_t count = beginShadows<P>(context, wave);
  for (size_t round = 0; count != 0 && round < kMostPassages; ++round) {
    tracePassing(context, wave, count);
    size_t out = 0;
    for (size_t i = 0; i < count; i += kLanes) {
      const auto met = surfaceMet<P>(scene, passing.rays, passing.hits, i, firstLanes(count - i));
      if (none(met.passes)) continue;
      const auto direction = loadVec3(passing.rays.directionX, passing.rays.directionY, passing.rays.directionZ, i);
      out = passLight(context, met, direction, load(passing.marks.index, i), load(passing.marks.number, i), wave, out);
    }
    count = out;
  }
  // What is left of each segment is tested as in any scene.
  scene.blockedRays(context, wave);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendPassing)
WAVECREST_INSTANTIATE_COMMON_STAGE(occludePassing)
