// What occlude does in a hierarchy of either kind, of one level (occlude_bvh.cpp) or two (occlude_instances.cpp).
#pragma once

#include "kernels/extend/bvh_ray.h"
#include "kernels/extend/visible_lanes.h"
#include "kernels/extend/walk_bvh.h"

WAVECREST_SIMD_BEGIN

// The columns of ShadowRays that hierarchies are walked with. They are floats under every precision policy, so that the
// walks are compiled once.
struct ShadowSegments {
  size_t size;
  const float *originX, *originY, *originZ, *directionX, *directionY, *directionZ;

  template <class S>
  explicit ShadowSegments(const ShadowRays<S>& rays)
      : size(rays.size),
        originX(rays.originX),
        originY(rays.originY),
        originZ(rays.originZ),
        directionX(rays.directionX),
        directionY(rays.directionY),
        directionZ(rays.directionZ) {}
};

// Shadow ray i, for which the walker's index is `index`. Ray: of bvh_ray.h, or one that knows instances.
template <class Ray>
WAVECREST_INLINE void beginShadowRay(Ray& ray, size_t index, const ShadowSegments& rays, size_t i) {
  ray.begin(index, rays.originX[i], rays.originY[i], rays.originZ[i], rays.directionX[i], rays.directionY[i],
            rays.directionZ[i], kShadowEnd);
}

// Each ray from `next` on alone. Writes `visible` of each.
template <class Ray>
WAVECREST_NOINLINE void walkShadowRaysAlone(const BvhView& bvh, const ShadowSegments& rays, size_t next,
                                            float* visible) {
  walkBvh<Ray>(
      bvh,
      [&](Ray& ray) HWY_ATTR {
        if (next >= rays.size) return false;
        beginShadowRay(ray, next, rays, next);
        ++next;
        return true;
      },
      [&](const Ray& ray) HWY_ATTR { visible[ray.index] = ray.hit.id == kMiss ? 1.0f : 0.0f; });
}

// The stage. walkAll(bvh, rays, visible): writes what walkShadowRaysAlone does.
template <class S, class WalkAll>
WAVECREST_INLINE void occludeThrough(const StageContext<S>& context, Wave<S>& wave, const WalkAll& walkAll) {
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;
  const Column<float>& visible = wave.visibility.visible;
  walkAll(*context.scene->bvh, ShadowSegments(shadow), visible);
  for (size_t i = 0; i < count; i += kLanes) {
    addVisible(context, wave, (load(visible, i) > Float(0)) & firstLanes(count - i), i);
  }
  shadow.size = 0;
}

WAVECREST_SIMD_END
