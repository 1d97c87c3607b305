// What the occlude stages do with the shadow rays that nothing blocks.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// Adds the contributions of block i where `visible` holds, in ray order: to lanes, or on light walks to the splats.
template <class S>
WAVECREST_INLINE void addVisible(const StageContext<S>& context, Wave<S>& wave, Mask visible, size_t i) {
  if (none(visible)) return;
  const auto& shadow = wave.shadowRays;
  const UInt target = load(shadow.target, i);
  const auto contribution = loadVec3(shadow.red, shadow.green, shadow.blue, i);
  if (context.contributesToLanes()) {
    addRadiance(wave.radiance, target, visible, contribution);
  } else {
    pushSplats(wave.splats, target, visible, contribution);
  }
}

WAVECREST_SIMD_END
