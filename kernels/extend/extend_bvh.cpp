// extend, large scenes: the closest hit of each ray in the hierarchy of bvh.h.
//
// in: Rays [n]. out: Hits [n], in ray order. Rays are in float under every precision policy. The result does not depend
// on the width of a block, nor on which rays are walked together.
#include "kernels/extend/extend_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void extendBvh(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  extendThrough<BvhRay<false>, BvhPacket>(context, wave);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendBvh)
