// occlude, scenes with instances: adds the contribution of each shadow ray that nothing in a hierarchy of two levels
// blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, Splats; ShadowRays empty. Every ray walks
// alone: those of a packet part at the instances that they pass.
#include "kernels/extend/occlude_lanes.h"
#include "kernels/extend/placed_rays.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void occludeInstances(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  occludeThrough(context, wave, [](const BvhView& bvh, const ShadowSegments& rays, float* visible) HWY_ATTR {
    walkShadowRaysAlone<PlacedRayOf<true>>(bvh, rays, 0, visible);
  });
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeInstances)
