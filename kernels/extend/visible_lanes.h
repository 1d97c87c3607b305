// What both occlude stages do with the shadow rays that nothing blocks.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// Asks for the pixels that rays will be splatted to, which lie all over the film.
WAVECREST_INLINE void prefetchPixels(const SplatSink& splats, const uint32_t* pixels, size_t count) {
  for (size_t k = 0; k < count; ++k) {
    const int64_t* const sums = splats.sums + 3 * size_t{pixels[k]};
    __builtin_prefetch(sums, 1);
    __builtin_prefetch(sums + 2, 1);  // three of eight pixels lie on two lines
  }
}

// Adds the contributions of block i where `visible` holds, in ray order: to lanes, or on light walks to the film.
template <class S>
WAVECREST_INLINE void addVisible(const StageContext<S>& context, Wave<S>& wave, Mask visible, size_t i) {
  if (none(visible)) return;
  const auto& shadow = wave.shadowRays;
  const UInt target = load(shadow.target, i);
  const auto contribution = loadVec3(shadow.red, shadow.green, shadow.blue, i);
  if (context.contributesToLanes()) {
    addRadiance(wave.radiance, target, visible, contribution);
  } else {
    addSplats(context, target, visible, contribution);
  }
}

WAVECREST_SIMD_END
