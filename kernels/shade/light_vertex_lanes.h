// Stored light vertices in lanes.
#pragma once

#include "kernels/columns/light_vertices.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/shading_lanes.h"

WAVECREST_SIMD_BEGIN

template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> gatherLightShading(const SceneView<typename P::Storage>& scene,
                                                               const LightVertices<typename P::Storage>& vertices,
                                                               UInt index) {
  using Real = typename P::Real;
  VertexLanes<Real> vertex{.position = gatherVec3(vertices.positionX, vertices.positionY, vertices.positionZ, index),
                           .fix = gatherVec3(vertices.fixX, vertices.fixY, vertices.fixZ, index),
                           .normal = gatherVec3(vertices.normalX, vertices.normalY, vertices.normalZ, index),
                           .shadingNormal = {},
                           .baseNormal = {},
                           .offset = gather(vertices.offset, index),
                           .u = Float(0),
                           .v = Float(0),
                           .primitive = gather(vertices.primitive, index)};
  vertex.shadingNormal = vertex.normal;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = gatherVec3(vertices.shadingX, vertices.shadingY, vertices.shadingZ, index);
  }
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps) vertex.baseNormal = gatherVec3(vertices.baseX, vertices.baseY, vertices.baseZ, index);
  }
  if constexpr (has(kFeatures, kTextures)) {
    vertex.u = gather(vertices.uvU, index);
    vertex.v = gather(vertices.uvV, index);
  }
  auto shading = shadingOf<P, kFeatures>(scene, vertex);
  shading.bsdf.walk = Walk::light;
  return shading;
}

template <class S>
WAVECREST_INLINE auto gatherLightMis(const LightVertices<S>& vertices, UInt index) {
  using Real = decltype(gather(vertices.dVCM, index));
  return MisSums<Real>{gather(vertices.dVCM, index), gather(vertices.dVC, index), gather(vertices.dVM, index)};
}

WAVECREST_SIMD_END
