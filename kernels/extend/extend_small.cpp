// extend, small scenes: the closest hit of each ray by testing every primitive.
//
// in: Rays [n]. out: Hits [n], in ray order. Rays are in float under every precision policy. The order of the tests
// decides ties, so the result does not depend on the width of a block.
#include "kernels/extend/offset.h"
#include "kernels/extend/small_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Closest hits of one block. u, v: coordinates in the primitive; for a sphere u is the distance t.
struct Closest {
  Float t, u, v;
  UInt primitive;

  WAVECREST_INLINE void take(Mask closer, const PlaneHit& hit, uint32_t index) {
    t = select(closer, hit.t, t);
    u = select(closer, hit.u, u);
    v = select(closer, hit.v, v);
    primitive = select(closer, UInt(index), primitive);
  }
};

WAVECREST_INLINE Closest closestHit(const SmallSceneView& scene, Vec3<Float> origin, Vec3<Float> direction) {
  Closest best{Float(3.0e38f), Float(0), Float(0), UInt(kMiss)};
  const auto nearer = [&](Float t) HWY_ATTR { return (t > Float(0)) & (t < best.t); };
  uint32_t index = 0;
  for (; index < scene.quadCount; ++index) {
    const PlaneHit hit = intersectPlane(scene.planes[index], origin, direction);
    best.take(insideQuad(hit, scene.limits[index]) & nearer(hit.t), hit, index);
  }
  if (index > 0) {  // from [-1, 1] with margin to [0, 1], kept off the edge
    const UInt quad = min(best.primitive, UInt(index - 1));
    const RecordLanes<PlaneLimits> at(scene.limits, quad);
    const auto uncentred = [](Float x, Float scale) HWY_ATTR {
      return min(max(mulAdd(x, scale, Float(0.5f)), Float(kInset)), Float(1 - kInset));
    };
    const auto limits = at.four(scene.limits->uScale);
    best.u = uncentred(best.u, limits.a);
    best.v = uncentred(best.v, limits.b);
  }
  for (const uint32_t end = index + scene.triangleCount; index < end; ++index) {
    const PlaneHit hit = intersectPlane(scene.planes[index], origin, direction);
    best.take(insideTriangle(hit, scene.limits[index]) & nearer(hit.t), hit, index);
  }
  if (scene.triangleCount > 0) {
    const Mask triangle = (best.primitive < UInt(index)) & !(best.primitive < UInt(index - scene.triangleCount));
    const Float u = max(best.u, Float(kInset)), v = max(best.v, Float(kInset));
    const Float scale = min(Float(1), Float(1 - kInset) / (u + v));
    best.u = select(triangle, u * scale, best.u);
    best.v = select(triangle, v * scale, best.v);
  }
  for (uint32_t i = 0; i < scene.sphereCount; ++i, ++index) {
    const Float t = intersectSphere(scene.spheres[i], origin, direction);
    best.take(nearer(t), {t, t, Float(0), Float(0)}, index);
  }
  return best;
}

}  // namespace

template <class P>
void extendSmall(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const SmallSceneView scene = *context.scene->small;
  const auto& rays = wave.rays;
  const size_t count = rays.size;
  context.counters->raysClosest += count;
  wave.hits.size = 0;
  wave.hits.claim(count);
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<Float> origin = to<Float>(loadVec3(rays.originX, rays.originY, rays.originZ, i));
    const Vec3<Float> direction = to<Float>(loadVec3(rays.directionX, rays.directionY, rays.directionZ, i));
    const Closest best = closestHit(scene, origin, direction);
    store(best.u, wave.hits.u, i);
    store(best.v, wave.hits.v, i);
    store(best.primitive, wave.hits.primitive, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendSmall)
