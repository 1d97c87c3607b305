// occlude, small scenes: adds the contribution of each shadow ray that nothing blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, Splats; ShadowRays empty.
#include <limits>

#include "kernels/extend/occlude_lanes.h"
#include "kernels/extend/small_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Rays of one block that meet something on their way.
struct Blocked {
  Float end;    // nothing beyond blocks
  Mask rays;    // blocked by a box or a sphere
  Float least;  // of edge + limit among the planes that are met: without a doubt up to 2

  WAVECREST_INLINE void take(Mask met, Float t, UInt) { rays = rays | (met & (t > Float(0)) & (t < end)); }
  WAVECREST_INLINE void take(const PlaneHit& hit, UInt) {
    const Mask met = (hit.edge <= hit.limit) & (hit.t > Float(0)) & (hit.t < end);
    least = select(met, min(least, hit.edge + hit.limit), least);
  }
};
constexpr float kNothingMet = std::numeric_limits<float>::max();

// The ray to the same end with a direction of length 1/4 to 1: scaled by a power of two, so that nothing is rounded.
struct Scaled {
  Vec3<Float> direction;
  Float end;
};
WAVECREST_INLINE Scaled scaledDown(Vec3<Float> direction) {
  constexpr uint32_t kExponent = 0x7f800000u;
  const UInt exponent = bits(maxComponent(abs(direction))) & UInt(kExponent);
  const UInt shortened = exponent + UInt(2u << 23);
  return {direction * fromBits(UInt(254u << 23) - shortened), fromBits(shortened)};
}

// Whether the doubtful rays of block i are blocked, decided one by one.
WAVECREST_NOINLINE Mask blockedByLeaves(const SmallSceneView& scene, const ShadowSegments& shadow, Mask doubtful,
                                        size_t i) {
  HWY_ALIGN uint32_t places[kLanes], blocked[kLanes] = {};
  store(compress(laneIndex(), doubtful), places);
  for (size_t k = 0, count = countTrue(doubtful); k < count; ++k) {
    const size_t at = i + places[k];
    BvhRay<true> ray;
    beginShadowRay(ray, at, shadow, at);
    visitLeaves(scene, ray);
    blocked[places[k]] = ray.hit.id != kMiss ? 1 : 0;
  }
  return load(blocked) == UInt(1u);
}

}  // namespace

template <class P>
void occludeSmall(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const SmallSceneView scene = *context.scene->small;
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<Float> origin = loadVec3(shadow.originX, shadow.originY, shadow.originZ, i);
    const Vec3<Float> direction = loadVec3(shadow.directionX, shadow.directionY, shadow.directionZ, i);
    const Mask present = firstLanes(count - i);
    const Scaled scaled = scaledDown(direction);
    Blocked found{scaled.end, noLanes(), Float(kNothingMet)};
    intersectAll(scene, origin, scaled.direction, found);
    Mask blocked = found.rays | (found.least <= Float(2));
    const Mask doubtful = andNot(present & (found.least < Float(kNothingMet)), blocked);
    if (any(doubtful)) blocked = blocked | blockedByLeaves(scene, ShadowSegments(shadow), doubtful, i);
    addVisible(context, wave, andNot(present, blocked), i);
  }
  shadow.size = 0;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeSmall)
