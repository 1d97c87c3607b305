// extend, scenes with instances: the closest hit of each ray in a hierarchy of two levels.
//
// in: Rays [n]. out: Hits [n], in ray order, with the instance of each. Otherwise as extend_bvh.cpp.
#include "kernels/extend/extend_lanes.h"
#include "kernels/extend/placed_rays.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P>
void extendInstances(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  extendThrough<PlacedRay, PlacedPacket>(context, wave);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendInstances)
