// occlude, large scenes: adds the contribution of each shadow ray that nothing in the hierarchy of bvh.h blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, Splats; ShadowRays empty.
#include "kernels/extend/bvh_ray.h"
#include "kernels/extend/visible_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void occludeBvh(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;
  // Rays end in any order, but contributions are added in theirs: what a ray sees takes the place of its origin.
  float* const visible = shadow.originX;
  size_t next = 0;
  walkBvh<BvhRay<true>>(
      *context.scene->bvh,
      [&](BvhRay<true>& ray) HWY_ATTR {
        if (next >= count) return false;
        ray.begin(next, shadow.originX[next], shadow.originY[next], shadow.originZ[next], shadow.directionX[next],
                  shadow.directionY[next], shadow.directionZ[next], kShadowEnd);
        ++next;
        return true;
      },
      [&](const BvhRay<true>& ray) HWY_ATTR { visible[ray.index] = ray.id == kMiss ? 1.0f : 0.0f; });
  for (size_t i = 0; i < count; i += kLanes) {
    addVisible(context, wave, (load(visible + i) > Float(0)) & firstLanes(count - i), i);
  }
  shadow.size = 0;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeBvh)
