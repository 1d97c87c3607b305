// The vertex of each lane as BSDFs want it: material, shading frame and the direction back along the path in it.
#pragma once

#include <cstring>

#include "kernels/shade/bsdf_lanes.h"
#include "kernels/shade/surface_lanes.h"
#include "kernels/shade/texture_lanes.h"

WAVECREST_SIMD_BEGIN

template <class P, uint32_t kFeatures>
struct ShadingLanes {
  using Real = typename P::Real;
  Vec3<Real> position, normal;
  Real offset;
  Frame<Real> frame;
  Vec3<Real> fix;  // in the frame, after turning a two-sided surface towards it
  Real side;       // -1 where a two-sided surface was turned, else 1
  Real fixCosine;  // fix . geometric normal, signed
  BsdfInput<P> bsdf;

  WAVECREST_INLINE Vec3<Real> toLocal(Vec3<Real> v) const {
    const Vec3<Real> local = frame.toLocal(v);
    return {local.x, local.y, local.z * side};
  }
  WAVECREST_INLINE Vec3<Real> toWorld(Vec3<Real> v) const { return frame.toWorld({v.x, v.y, v.z * side}); }

  // Lanes where the geometric and the shading normal agree on which side gen lies; elsewhere light would leak through
  // the surface (Veach 1997, 5.3), so f is taken as zero.
  WAVECREST_INLINE Mask sidesAgree(Vec3<Real> gen, Vec3<Real> genLocal) const {
    if constexpr (has(kFeatures, kShadingNormals | kTextures)) {
      const Real geometric = dot(gen, normal) * side;
      const Mask genAgrees = (geometric * genLocal.z) > Real(0);
      const Mask fixAgrees = (fixCosine * side * fix.z) > Real(0);
      return genAgrees & fixAgrees;
    } else {
      return gen.x == gen.x;
    }
  }
};

// What a vertex is, before its material is known: of a live path, or of a stored light vertex.
template <class Real>
struct VertexLanes {
  Vec3<Real> position, fix, normal, shadingNormal;
  Real offset;
  Float u, v;  // texture coordinates
  UInt material;
};

template <class S>
WAVECREST_INLINE UInt materialOf(const SceneView<S>& scene, UInt primitive) {
  return RecordLanes<PrimitiveRecord<S>>(scene.primitives, primitive)(scene.primitives->material);
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> shadingOf(const SceneView<typename P::Storage>& scene,
                                                      const VertexLanes<typename P::Real>& vertex) {
  using Real = typename P::Real;
  ShadingLanes<P, kFeatures> s{.position = vertex.position,
                               .normal = vertex.normal,
                               .offset = vertex.offset,
                               .frame = Frame<Real>::fromNormal(vertex.shadingNormal),
                               .fix = {},
                               .side = Real(1),
                               .fixCosine = dot(vertex.fix, vertex.normal),
                               .bsdf = BsdfInput<P>(scene.materials, vertex.material)};
  if constexpr (has(kFeatures, kTextures)) {
    const MaterialRecord& slots = *scene.materials;
    const auto factor = [&](const uint32_t& slot) HWY_ATTR {
      return to<Real>(textureFactor(scene.textures, scene.texels, s.bsdf.at(slot), vertex.u, vertex.v));
    };
    s.bsdf.reflectanceFactor = factor(slots.reflectanceTexture);
    s.bsdf.specularFactor = factor(slots.specularTexture);
    s.bsdf.transmittanceFactor = factor(slots.transmittanceTexture);
    s.bsdf.alphaFactor = factor(slots.alphaTexture).x;
    s.bsdf.opacityFactor = factor(slots.opacityTexture).x;
  }
  s.fix = s.frame.toLocal(vertex.fix);
  const Mask twoSided = (s.bsdf.flags & UInt(kTwoSided)) == UInt(kTwoSided);
  s.side = select(twoSided & (s.fix.z < Real(0)), Real(-1), Real(1));
  s.fix.z = s.fix.z * s.side;
  return s;
}

// Block i of the live paths' vertices.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> loadShading(const SceneView<typename P::Storage>& scene,
                                                        const Wave<typename P::Storage>& wave, Mask active, size_t i) {
  using Real = typename P::Real;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  VertexLanes<Real> vertex{.position = loadVec3(rays.originX, rays.originY, rays.originZ, i),
                           .fix = -loadVec3(rays.directionX, rays.directionY, rays.directionZ, i),
                           .normal = loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i),
                           .shadingNormal = {},
                           .offset = load(surfaces.offset, i),
                           .u = Float(0),
                           .v = Float(0),
                           .material = materialOf(scene, select(active, load(wave.hits.primitive, i), UInt(0u)))};
  vertex.shadingNormal = vertex.normal;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = loadVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, i);
  }
  if constexpr (has(kFeatures, kTextures)) {
    vertex.u = load(surfaces.uvU, i);
    vertex.v = load(surfaces.uvV, i);
  }
  return shadingOf<P, kFeatures>(scene, vertex);
}

// The rows of the live paths' vertices, if no stage has written them at this depth yet.
template <class S>
WAVECREST_INLINE void packVertexRows(const SceneView<S>& scene, Wave<S>& wave) {
  auto& rows = wave.vertexRows;
  if (rows.size != 0) return;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  const auto& paths = wave.paths;
  const size_t count = rays.size;
  rows.claim(count);
  for (size_t i = 0; i < count; i += kLanes) {
    const auto position = loadVec3(rays.originX, rays.originY, rays.originZ, i);
    const auto fix = -loadVec3(rays.directionX, rays.directionY, rays.directionZ, i);
    const auto normal = loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i);
    const auto throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    using Real = decltype(position.x);
    const UInt primitive = select(firstLanes(count - i), load(wave.hits.primitive, i), UInt(0u));
    constexpr size_t kPieces = 4;
    HWY_ALIGN S pieces[kPieces][4 * kLanes];
    storeInterleaved(position.x, position.y, position.z, load(surfaces.offset, i), pieces[0]);
    storeInterleaved(fix.x, fix.y, fix.z, to<Real>(toFloat(materialOf(scene, primitive))), pieces[1]);
    storeInterleaved(normal.x, normal.y, normal.z, load(paths.dVCM, i), pieces[2]);
    storeInterleaved(throughput.x, throughput.y, throughput.z, load(paths.dVC, i), pieces[3]);
    static_assert(sizeof(VertexRow<S>) == kPieces * 4 * sizeof(S));
    // The tail of a column has room for whole blocks.
    S* const out = rows.row[i].position;
    for (size_t k = 0; k < kLanes; ++k) {
      for (size_t piece = 0; piece < kPieces; ++piece) {
        std::memcpy(out + 4 * (kPieces * k + piece), &pieces[piece][4 * k], 4 * sizeof(S));
      }
    }
  }
}

// The live paths' vertices at any indices, and what else their rows hold.
template <class P, uint32_t kFeatures>
struct RowLanes {
  using Real = typename P::Real;
  ShadingLanes<P, kFeatures> shading;
  Vec3<Real> throughput;
  Real dVCM, dVC;
};
template <class P, uint32_t kFeatures>
WAVECREST_INLINE RowLanes<P, kFeatures> gatherRows(const SceneView<typename P::Storage>& scene,
                                                   const Wave<typename P::Storage>& wave, UInt index) {
  using Real = typename P::Real;
  using S = typename P::Storage;
  const VertexRow<S>& row = *wave.vertexRows.row;
  const UInt start = index * UInt(sizeof(row) / sizeof(S));
  const FourColumns<Real> place = gatherFour(row.position, start), back = gatherFour(row.fix, start),
                          side = gatherFour(row.normal, start), carried = gatherFour(row.throughput, start);
  VertexLanes<Real> vertex{.position = {place.a, place.b, place.c},
                           .fix = {back.a, back.b, back.c},
                           .normal = {side.a, side.b, side.c},
                           .shadingNormal = {},
                           .offset = place.d,
                           .u = Float(0),
                           .v = Float(0),
                           .material = toUInt(to<Float>(back.d))};
  vertex.shadingNormal = vertex.normal;
  const auto& surfaces = wave.surfaces;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = gatherVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, index);
  }
  if constexpr (has(kFeatures, kTextures)) {
    vertex.u = gather(surfaces.uvU, index);
    vertex.v = gather(surfaces.uvV, index);
  }
  return {shadingOf<P, kFeatures>(scene, vertex), {carried.a, carried.b, carried.c}, side.d, carried.d};
}

WAVECREST_SIMD_END
