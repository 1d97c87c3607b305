// Vertices as rows of sixteen numbers, and rows read back into lanes in any order. One load a lane brings four numbers;
// gathering columns one by one would cost several times the arithmetic of what joins two vertices.
#pragma once

#include "kernels/mis_lanes.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/shade/vertex_tag.h"
#include "kernels/simd/interleave.h"

WAVECREST_SIMD_BEGIN

// The rows of block i of the live paths' vertices; edges: from the light, where they are kept as light vertices.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE auto makeRows(const StageContext<S>& context, const Wave<S>& wave, size_t i, uint32_t edges) {
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  const auto& paths = wave.paths;
  const auto position = loadVec3(rays.originX, rays.originY, rays.originZ, i);
  const auto wi = -loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
  const auto normal = loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i);
  const auto throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
  const auto mis = loadMis<kFeatures>(paths, i);
  const UInt primitive = select(firstLanes(rays.size - i), load(wave.hits.primitive, i), UInt(0u));
  RecordBlock<decltype(position.x)> rows;
  rows.set(0, position.x, position.y, position.z, load(surfaces.offset, i));
  rows.set(1, wi.x, wi.y, wi.z, packTag(materialOf(*context.scene, primitive), edges, wi.x));
  rows.set(2, normal.x, normal.y, normal.z, mis.dVCM);
  rows.set(3, throughput.x, throughput.y, throughput.z, mis.dVC);
  return rows;
}

// The rows of the live paths' vertices that can be joined, if no stage has written them at this depth yet.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE void packVertexRows(const StageContext<S>& context, Wave<S>& wave) {
  auto& rows = wave.vertexRows;
  if (rows.size != 0) return;
  const size_t count = wave.joinable;
  rows.claim(count);
  // The tail of a column has room for whole blocks.
  for (size_t i = 0; i < count; i += kLanes) makeRows<kFeatures>(context, wave, i, 0).store(rows.row + i);
}

// Vertices at any indices, and what else their rows hold.
template <class P, uint32_t kFeatures>
struct RowLanes {
  using Real = typename P::Real;
  ShadingLanes<P, kFeatures> shading;
  Vec3<Real> throughput;
  MisSums<Real> mis;
};

// index: of a row for every lane. columns: what rows do not hold, at the same indices, as Surfaces or LightVertices.
template <class P, uint32_t kFeatures, class Columns>
WAVECREST_INLINE RowLanes<P, kFeatures> gatherRows(const SceneView<typename P::Storage>& scene,
                                                   const VertexRow<typename P::Storage>* rows, const Columns& columns,
                                                   const uint32_t* index) {
  using Real = typename P::Real;
  const FourColumns<Real> place = loadFour([&](size_t k) WAVECREST_LAMBDA { return rows[index[k]].position; }),
                          back = loadFour([&](size_t k) WAVECREST_LAMBDA { return rows[index[k]].wi; }),
                          side = loadFour([&](size_t k) WAVECREST_LAMBDA { return rows[index[k]].normal; }),
                          carried = loadFour([&](size_t k) WAVECREST_LAMBDA { return rows[index[k]].throughput; });
  const Vec3<Real> normal{side.a, side.b, side.c};
  const UInt at = loadUnaligned(index);
  const VertexLanes<Real> vertex{
      .position = {place.a, place.b, place.c},
      .wi = {back.a, back.b, back.c},
      .normal = normal,
      .offset = place.d,
      .material = materialOfTag(back.d),
      .details = readDetails<kFeatures>(columns, normal,
                                        [&](const auto& column) WAVECREST_LAMBDA { return gather(column, at); })};
  return {shadingOf<P, kFeatures>(scene, vertex), {carried.a, carried.b, carried.c}, {side.d, carried.d}};
}

WAVECREST_SIMD_END
