// occlude, small scenes: adds the contribution of each shadow ray that nothing blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, the film; ShadowRays empty.
#include <algorithm>

#include "kernels/extend/small_lanes.h"
#include "kernels/extend/visible_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

WAVECREST_INLINE Mask blocked(const SmallSceneView& scene, Vec3<Float> origin, Vec3<Float> direction) {
  Mask hit = noLanes();
  const auto within = [](Float t) HWY_ATTR { return (t > Float(0)) & (t < Float(1)); };
  uint32_t box = 0;
  for (; box < scene.closedBoxCount; ++box) {
    const BoxHit at = intersectBox<false>(scene.boxes[box], origin, direction);
    hit = hit | (at.hit & within(at.t));
  }
  for (const uint32_t end = box + scene.openBoxCount; box < end; ++box) {
    const BoxHit at = intersectBox<true>(scene.boxes[box], origin, direction);
    hit = hit | (at.hit & within(at.t));
  }
  uint32_t plane = 0;
  for (; plane < scene.quadCount; ++plane) {
    const PlaneHit at = intersectPlane(scene.planes[plane], origin, direction);
    hit = hit | (insideQuad(at, scene.limits[plane]) & within(at.t));
  }
  for (const uint32_t end = plane + scene.triangleCount; plane < end; ++plane) {
    const PlaneHit at = intersectPlane(scene.planes[plane], origin, direction);
    hit = hit | (insideTriangle(at, scene.limits[plane]) & within(at.t));
  }
  for (uint32_t i = 0; i < scene.sphereCount; ++i) {
    hit = hit | within(intersectSphere(scene.spheres[i], origin, direction));
  }
  return hit;
}

}  // namespace

template <class P>
void occludeSmall(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const SmallSceneView scene = *context.scene->small;
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;
  const bool splatting = !context.contributesToLanes();
  for (size_t i = 0; i < count; i += kLanes) {
    if (splatting) prefetchPixels(context.splats, shadow.target + i, std::min(kLanes, count - i));
    const Vec3<Float> origin = loadVec3(shadow.originX, shadow.originY, shadow.originZ, i);
    const Vec3<Float> direction = loadVec3(shadow.directionX, shadow.directionY, shadow.directionZ, i);
    addVisible(context, wave, andNot(firstLanes(count - i), blocked(scene, origin, direction)), i);
  }
  shadow.size = 0;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeSmall)
