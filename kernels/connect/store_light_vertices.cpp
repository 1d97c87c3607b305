// storeLightVertices: keeps each light vertex that camera paths can join, for connections, for merging, or for both.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n] of a light walk. out: the next depth of the context's light
// store [<= n], in that order; nothing else changes. The caller has begun the depth, so there is room.
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_grid_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The vertices of all waves are more than the caches hold: asks for the lines that later blocks will be written to.
constexpr size_t kColumnsAhead = 64, kRowsAhead = 48;  // items
template <class... Items>
WAVECREST_INLINE void prefetchColumns(size_t out, const Column<Items>&... columns) {
  (__builtin_prefetch(columns + out + kColumnsAhead, 1), ...);
}

// What a photon map is built from.
template <class S>
WAVECREST_INLINE void appendPlaces(const PhotonGrid<S>& grid, const Rays<S>& rays, size_t i, Mask m,
                                   LightVertices<S>& vertices, size_t out) {
  prefetchColumns(out, vertices.cell, vertices.place);
  const auto position = loadVec3(rays.originX, rays.originY, rays.originZ, i);
  const PlaceLanes at = placesOf(GridLanes<decltype(position.x)>(grid)(position));
  append(at.cell, m, vertices.cell, out);
  append(at.place, m, vertices.place, out);
}

// What connections and merges read.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE void appendRows(const StageContext<S>& context, const Wave<S>& wave, size_t i, Mask m,
                                 LightVertices<S>& vertices, size_t out) {
  RecordBlock<S> rows;
  makeRows<kFeatures>(context, wave, i, context.depth, rows);
  rows.append(m, vertices.row + out, kRowsAhead);
}

// What connections read beside rows.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE void appendColumns(const SceneView<S>& scene, const Wave<S>& wave, size_t i, Mask m,
                                    LightVertices<S>& vertices, size_t out) {
  const auto& surfaces = wave.surfaces;
  if constexpr (has(kFeatures, kShadingNormals)) {
    appendVec3(loadVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, i), m, vertices.shadingX,
               vertices.shadingY, vertices.shadingZ, out);
  }
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps) {
      appendVec3(loadVec3(surfaces.baseX, surfaces.baseY, surfaces.baseZ, i), m, vertices.baseX, vertices.baseY,
                 vertices.baseZ, out);
    }
  }
  if constexpr (has(kFeatures, kTextures)) {
    append(load(surfaces.uvU, i), m, vertices.uvU, out);
    append(load(surfaces.uvV, i), m, vertices.uvV, out);
  }
}

}  // namespace

template <class P, uint32_t kFeatures>
void storeLightVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  LightStore<typename P::Storage>& store = *context.light;
  auto& vertices = store.vertices;
  const bool connected = store.keepsLanes(), merged = store.keepsPlaces();
  size_t out = vertices.size;
  for (size_t i = 0; i < wave.joinable; i += kLanes) {
    const Mask joinable = firstLanes(wave.joinable - i);
    appendRows<kFeatures>(context, wave, i, joinable, vertices, out);
    if (connected) {
      appendColumns<kFeatures>(*context.scene, wave, i, joinable, vertices, out);
      prefetchColumns(out, vertices.lane, vertices.next);
      append(load(wave.paths.lane, i), joinable, vertices.lane, out);
    }
    if (merged) appendPlaces(context.photonGrid, wave.rays, i, joinable, vertices, out);
    out += countTrue(joinable);
  }
  if (connected) store.link(vertices.size, out);
  context.counters->lightVertices += out - vertices.size;
  vertices.claim(out - vertices.size);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(storeLightVertices)
