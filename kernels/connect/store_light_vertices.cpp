// storeLightVertices: keeps each light vertex that camera paths can join.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n] of a light walk. out: the next depth of the context's light
// store [<= n], in lane order; nothing else changes. The caller has begun the depth, so there is room.
#include "kernels/columns/light_vertices.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P, uint32_t kFeatures>
void storeLightVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  const auto& paths = wave.paths;
  auto& vertices = context.light->vertices;
  const size_t count = rays.size;
  size_t out = vertices.size;

  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt primitive = select(active, load(wave.hits.primitive, i), UInt(0u));
    Mask joinable = active;
    if constexpr (has(kFeatures, kSpecularBsdfs)) {
      const RecordLanes<PrimitiveRecord<typename P::Storage>> at(scene.primitives, primitive);
      const RecordLanes<MaterialRecord> material(scene.materials, at(scene.primitives->material));
      joinable = active & hasNonDeltaLobes(material(scene.materials->kind));
    }
    appendVec3(loadVec3(rays.originX, rays.originY, rays.originZ, i), joinable, vertices.positionX, vertices.positionY,
               vertices.positionZ, out);
    appendVec3(-loadVec3(rays.directionX, rays.directionY, rays.directionZ, i), joinable, vertices.fixX, vertices.fixY,
               vertices.fixZ, out);
    appendVec3(loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i), joinable, vertices.normalX,
               vertices.normalY, vertices.normalZ, out);
    append(load(surfaces.offset, i), joinable, vertices.offset, out);
    if constexpr (has(kFeatures, kShadingNormals)) {
      appendVec3(loadVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, i), joinable, vertices.shadingX,
                 vertices.shadingY, vertices.shadingZ, out);
    }
    if constexpr (has(kFeatures, kTextures)) {
      append(load(surfaces.uvU, i), joinable, vertices.uvU, out);
      append(load(surfaces.uvV, i), joinable, vertices.uvV, out);
    }
    appendVec3(loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i), joinable, vertices.throughputR,
               vertices.throughputG, vertices.throughputB, out);
    const MisSums<Real> mis = loadMis<kFeatures>(paths, i);
    append(mis.dVCM, joinable, vertices.dVCM, out);
    append(mis.dVC, joinable, vertices.dVC, out);
    append(mis.dVM, joinable, vertices.dVM, out);
    append(primitive, joinable, vertices.primitive, out);
    append(UInt(context.depth), joinable, vertices.depth, out);
    append(load(paths.lane, i), joinable, vertices.lane, out);
    out += countTrue(joinable);
  }
  context.counters->lightVertices += out - vertices.size;
  vertices.claim(out - vertices.size);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(storeLightVertices)
