// storeLightVertices: keeps each light vertex that camera paths can join, for connections, for merging, or for both.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n] of a light walk. out: the next depth of the context's light
// store [<= n], in lane order; nothing else changes. The caller has begun the depth, so there is room.
#include <algorithm>
#include <limits>

#include "kernels/columns/light_vertices.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Vertices of block i of a light walk that more than delta lobes can join.
template <uint32_t kFeatures, class S>
WAVECREST_INLINE Mask joinableVertices(const SceneView<S>& scene, const Wave<S>& wave, size_t i) {
  const Mask active = firstLanes(wave.rays.size - i);
  if constexpr (has(kFeatures, kSpecularBsdfs)) {
    const UInt primitive = select(active, load(wave.hits.primitive, i), UInt(0u));
    const RecordLanes<PrimitiveRecord<S>> at(scene.primitives, primitive);
    const MaterialLanes material(scene, at(scene.primitives->material));
    return active & hasNonDeltaLobes(material(scene.materials->kind));
  } else {
    return active;
  }
}

// The vertices of all waves are more than the caches hold: asks for the lines that later blocks will be written to.
constexpr size_t kColumnsAhead = 64, kRowsAhead = 48;  // items
template <class... Items>
WAVECREST_INLINE void prefetchColumns(size_t out, const Column<Items>&... columns) {
  (__builtin_prefetch(columns + out + kColumnsAhead, 1), ...);
}

template <class S>
WAVECREST_INLINE auto appendPosition(const Rays<S>& rays, size_t i, Mask m, LightVertices<S>& vertices, size_t out) {
  prefetchColumns(out, vertices.positionX, vertices.positionY, vertices.positionZ);
  const auto position = loadVec3(rays.originX, rays.originY, rays.originZ, i);
  appendVec3(position, m, vertices.positionX, vertices.positionY, vertices.positionZ, out);
  return position;
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
  prefetchColumns(out, vertices.lane);
  append(load(wave.paths.lane, i), m, vertices.lane, out);
}

// The box around the positions of several blocks.
template <class Real>
class BoundsLanes {
 public:
  WAVECREST_INLINE BoundsLanes() {
    const Real infinity(std::numeric_limits<double>::infinity());
    low_ = {infinity, infinity, infinity};
    high_ = {-infinity, -infinity, -infinity};
  }
  WAVECREST_INLINE void include(Vec3<Real> p, Mask m) {
    low_ = {min(low_.x, select(m, p.x, low_.x)), min(low_.y, select(m, p.y, low_.y)),
            min(low_.z, select(m, p.z, low_.z))};
    high_ = {max(high_.x, select(m, p.x, high_.x)), max(high_.y, select(m, p.y, high_.y)),
             max(high_.z, select(m, p.z, high_.z))};
  }
  WAVECREST_INLINE Bounds<typename Real::Storage> overLanes() const {
    using S = typename Real::Storage;
    Bounds<S> bounds;
    const Real* const columns[2][3] = {{&low_.x, &low_.y, &low_.z}, {&high_.x, &high_.y, &high_.z}};
    for (size_t axis = 0; axis < 3; ++axis) {
      HWY_ALIGN S low[kLanes]{}, high[kLanes]{};  // clang-tidy does not see that store fills them
      store(*columns[0][axis], low);
      store(*columns[1][axis], high);
      bounds.low[axis] = *std::min_element(low, low + kLanes);
      bounds.high[axis] = *std::max_element(high, high + kLanes);
    }
    return bounds;
  }

 private:
  Vec3<Real> low_, high_;
};

}  // namespace

template <class P, uint32_t kFeatures>
void storeLightVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  LightStore<typename P::Storage>& store = *context.light;
  auto& vertices = store.vertices;
  const bool connected = store.keepsLanes(), merged = store.keepsPositions();
  size_t out = vertices.size;
  BoundsLanes<typename P::Real> bounds;
  for (size_t i = 0; i < wave.rays.size; i += kLanes) {
    const Mask joinable = joinableVertices<kFeatures>(*context.scene, wave, i);
    appendRows<kFeatures>(context, wave, i, joinable, vertices, out);
    if (connected) appendColumns<kFeatures>(*context.scene, wave, i, joinable, vertices, out);
    if (merged) bounds.include(appendPosition(wave.rays, i, joinable, vertices, out), joinable);
    out += countTrue(joinable);
  }
  if (merged) store.include(bounds.overLanes(), out - vertices.size);
  context.counters->lightVertices += out - vertices.size;
  vertices.claim(out - vertices.size);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(storeLightVertices)
