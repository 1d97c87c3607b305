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

// The vertices of all waves are more than the caches hold: prefetches the lines that later blocks will be written to.
constexpr size_t kColumnsAhead = 64;  // items
template <class... Items>
WAVECREST_INLINE void prefetchColumns(size_t out, const Column<Items>&... columns) {
  (__builtin_prefetch(columns + out + kColumnsAhead, 1), ...);
}

// What a photon map is built from, of block i of the wave, as those below.
template <class S>
WAVECREST_INLINE void storePlaces(const PhotonGrid<S>& grid, const Rays<S>& rays, size_t i, LightVertices<S>& vertices,
                                  size_t out) {
  prefetchColumns(out, vertices.cell, vertices.place);
  const auto position = loadVec3(rays.originX, rays.originY, rays.originZ, i);
  const PlaceLanes at = placesOf(GridLanes<decltype(position.x)>(grid)(position));
  storeUnaligned(at.cell, vertices.cell + out);
  storeUnaligned(at.place, vertices.place + out);
}

// What connections and merges read.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE void storeRows(const StageContext<S>& context, const Wave<S>& wave, size_t i,
                                LightVertices<S>& vertices, size_t out, bool kept) {
  const auto rows = makeRows<kFeatures>(context, wave, i, context.depth);
  if (kept) {
    rows.stream(vertices.row + out);
  } else {
    rows.store(vertices.row + out);
  }
}

// What connections read besides rows.
template <uint32_t kFeatures, class Real, class S>
WAVECREST_INLINE void storeColumns(const Wave<S>& wave, size_t i, LightVertices<S>& vertices, size_t out) {
  VertexDetailLanes<Real> details;
  details.template read<kFeatures>(wave.surfaces, [&](const auto& column) WAVECREST_LAMBDA { return load(column, i); });
  details.template forEach<kFeatures>(
      vertices, [&](const auto& number, const auto& column) WAVECREST_LAMBDA { storeUnaligned(number, column + out); });
  prefetchColumns(out, vertices.lane, vertices.next);
  storeUnaligned(load(wave.paths.lane, i), vertices.lane + out);
}

}  // namespace

template <class P, uint32_t kFeatures>
void storeLightVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  LightStore<typename P::Storage>& store = *context.light.store;
  auto& vertices = store.vertices;
  // Connections alone read vertices soon; for merging all waves of an iteration are stored before one is read.
  const bool connected = store.keepsLanes(), merged = store.keepsPlaces();
  const size_t first = vertices.claim(wave.joinable);
  // The tail of a column has room for whole blocks.
  for (size_t i = 0; i < wave.joinable; i += kLanes) {
    storeRows<kFeatures>(context, wave, i, vertices, first + i, merged);
    if (connected) storeColumns<kFeatures, typename P::Real>(wave, i, vertices, first + i);
    if (merged) storePlaces(context.light.grid, wave.rays, i, vertices, first + i);
  }
  if (merged) flushStream();
  if (connected) store.link(wave.joinable, onlyDiffuse(kFeatures) ? wave.joinable : wave.diffuse);
  context.counters->lightVertices += wave.joinable;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(storeLightVertices)
