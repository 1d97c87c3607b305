// Vertices are in the order of their BSDFs (vertex_order_lanes.h): stages that shade them have kernels of their own for
// whole blocks of diffuse ones, and those of their feature set for the others.
#pragma once

#include <algorithm>
#include <type_traits>

#include "kernels/shade/bsdf_lanes.h"

WAVECREST_SIMD_BEGIN

// Calls shade(features, begin, end) for the vertices [0, count) of the wave: features is a std::integral_constant of
// what they need, begin a multiple of kLanes.
template <uint32_t kFeatures, class S, class Shade>
WAVECREST_INLINE void forEachBsdfRange(const Wave<S>& wave, size_t count, const Shade& shade) {
  size_t begin = 0;
  if constexpr (!onlyDiffuse(kFeatures)) {
    begin = std::min(wave.diffuse, count) / kLanes * kLanes;
    if (begin != 0) shade(std::integral_constant<uint32_t, kFeatures & ~(kSpecularBsdfs | kLayeredBsdfs)>(), 0, begin);
  }
  if (begin != count) shade(std::integral_constant<uint32_t, kFeatures>(), begin, count);
}

WAVECREST_SIMD_END
