// The vertex of each lane as BSDFs want it: material, shading frame and the direction back along the path in it.
#pragma once

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
  BsdfInputOf<P, kFeatures> bsdf;

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
  UInt primitive;
};

template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> shadingOf(const SceneView<typename P::Storage>& scene,
                                                      const VertexLanes<typename P::Real>& vertex) {
  using Real = typename P::Real;
  const RecordLanes<PrimitiveRecord<typename P::Storage>> at(scene.primitives, vertex.primitive);
  ShadingLanes<P, kFeatures> s{.position = vertex.position,
                               .normal = vertex.normal,
                               .offset = vertex.offset,
                               .frame = Frame<Real>::fromNormal(vertex.shadingNormal),
                               .fix = {},
                               .side = Real(1),
                               .fixCosine = dot(vertex.fix, vertex.normal),
                               .bsdf = BsdfInputOf<P, kFeatures>(scene.materials, at(scene.primitives->material))};
  if constexpr (has(kFeatures, kTextures)) {
    const MaterialRecord& slots = *scene.materials;
    const auto factor = [&](const uint32_t& slot) HWY_ATTR {
      return to<Real>(textureFactor(scene.textures, scene.texels, s.bsdf.at(slot), vertex.u, vertex.v));
    };
    s.bsdf.textures.reflectance = factor(slots.reflectanceTexture);
    s.bsdf.textures.specular = factor(slots.specularTexture);
    s.bsdf.textures.transmittance = factor(slots.transmittanceTexture);
    s.bsdf.textures.alpha = factor(slots.alphaTexture).x;
    s.bsdf.textures.opacity = factor(slots.opacityTexture).x;
  }
  s.fix = s.frame.toLocal(vertex.fix);
  const Mask twoSided = (s.bsdf.at(scene.materials->flags) & UInt(kTwoSided)) == UInt(kTwoSided);
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
                           .primitive = select(active, load(wave.hits.primitive, i), UInt(0u))};
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

// The live paths' vertices at any indices.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> gatherShading(const SceneView<typename P::Storage>& scene,
                                                          const Wave<typename P::Storage>& wave, UInt index) {
  using Real = typename P::Real;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  VertexLanes<Real> vertex{.position = gatherVec3(rays.originX, rays.originY, rays.originZ, index),
                           .fix = -gatherVec3(rays.directionX, rays.directionY, rays.directionZ, index),
                           .normal = gatherVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, index),
                           .shadingNormal = {},
                           .offset = gather(surfaces.offset, index),
                           .u = Float(0),
                           .v = Float(0),
                           .primitive = gather(wave.hits.primitive, index)};
  vertex.shadingNormal = vertex.normal;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = gatherVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, index);
  }
  if constexpr (has(kFeatures, kTextures)) {
    vertex.u = gather(surfaces.uvU, index);
    vertex.v = gather(surfaces.uvV, index);
  }
  return shadingOf<P, kFeatures>(scene, vertex);
}

WAVECREST_SIMD_END
