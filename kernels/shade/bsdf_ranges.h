// Vertices are in the order of their BSDFs (vertex_order_lanes.h): stages that shade them have kernels of their own for
// whole blocks of diffuse ones, and those of their feature set for the others.
#pragma once

#include <algorithm>
#include <type_traits>

#include "kernels/bsdf/bsdf_lanes.h"

WAVECREST_SIMD_BEGIN

// The features that shading a vertex depends on. Feature sets that differ in others only share its code.
constexpr uint32_t kShadedFeatures = kOtherBsdfs | kTextures | kShadingNormals | kNormalMaps;

// Calls shade(features). features: a std::integral_constant of the features that shading needs, without kOtherBsdfs
// where all vertices are diffuse.
template <uint32_t kFeatures, class Shade>
WAVECREST_INLINE auto withBsdfs(bool diffuse, const Shade& shade) {
  if constexpr (!onlyDiffuse(kFeatures)) {
    if (diffuse) return shade(std::integral_constant<uint32_t, kFeatures & kShadedFeatures & ~kOtherBsdfs>());
  }
  return shade(std::integral_constant<uint32_t, kFeatures & kShadedFeatures>());
}

// Calls shade(features, begin, end) for the vertices [0, count) of the wave, features as above; begin is a multiple of
// kLanes.
template <uint32_t kFeatures, class S, class Shade>
WAVECREST_INLINE void forEachBsdfRange(const Wave<S>& wave, size_t count, const Shade& shade) {
  const size_t diffuse = onlyDiffuse(kFeatures) ? 0 : std::min(wave.diffuse, count) / kLanes * kLanes;
  if (diffuse != 0) withBsdfs<kFeatures>(true, [&](auto bsdfs) WAVECREST_LAMBDA { shade(bsdfs, 0, diffuse); });
  if (diffuse != count) withBsdfs<kFeatures>(false, [&](auto bsdfs) WAVECREST_LAMBDA { shade(bsdfs, diffuse, count); });
}

// Whether all of a vector of the wave's vertices are diffuse, where withBsdfs tells them apart.
template <class S>
WAVECREST_INLINE bool allDiffuse(const Wave<S>& wave, UInt vertex) {
  return all(vertex < UInt(static_cast<uint32_t>(wave.diffuse)));
}

WAVECREST_SIMD_END
