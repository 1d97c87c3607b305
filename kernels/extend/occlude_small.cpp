// occlude, small scenes: adds the contribution of each shadow ray that nothing blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, the film; ShadowRays empty.
#include <algorithm>

#include "kernels/extend/small_lanes.h"
#include "kernels/extend/visible_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Rays of one block that meet something on their way.
struct Blocked {
  Mask rays;

  WAVECREST_INLINE void take(Mask met, Float t, UInt) { rays = rays | (met & (t > Float(0)) & (t < Float(1))); }
};

// Pixels lie all over the film: those of so many rays are asked for ahead.
constexpr size_t kPixelsAhead = 128;

}  // namespace

template <class P>
void occludeSmall(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const SmallSceneView scene = *context.scene->small;
  auto& shadow = wave.shadowRays;
  const size_t count = shadow.size;
  context.counters->raysShadow += count;
  const bool splatting = !context.contributesToLanes();
  size_t asked = 0;  // rays whose pixels are on their way
  for (size_t i = 0; i < count; i += kLanes) {
    if (splatting) {
      const size_t next = std::min(i + kPixelsAhead, count);
      prefetchPixels(context.splats, shadow.target + asked, next - asked);
      asked = next;
    }
    const Vec3<Float> origin = loadVec3(shadow.originX, shadow.originY, shadow.originZ, i);
    const Vec3<Float> direction = loadVec3(shadow.directionX, shadow.directionY, shadow.directionZ, i);
    Blocked blocked{noLanes()};
    intersectAll(scene, origin, direction, blocked);
    addVisible(context, wave, andNot(firstLanes(count - i), blocked.rays), i);
  }
  shadow.size = 0;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeSmall)
