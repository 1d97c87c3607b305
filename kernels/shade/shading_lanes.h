// The vertex of each lane as BSDFs want it: material, shading frame and the direction back along the path in it.
#pragma once

#include "kernels/shade/bsdf_lanes.h"
#include "kernels/shade/surface_lanes.h"

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

template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> loadShading(const SceneView<typename P::Storage>& scene,
                                                        const Wave<typename P::Storage>& wave, Mask active, size_t i) {
  using Real = typename P::Real;
  const UInt primitive = select(active, load(wave.hits.primitive, i), UInt(0u));
  const RecordLanes<PrimitiveRecord<typename P::Storage>> at(scene.primitives, primitive);
  const auto& surfaces = wave.surfaces;
  ShadingLanes<P, kFeatures> s{.position = loadVec3(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i),
                               .normal = loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i),
                               .offset = load(surfaces.offset, i),
                               .frame = {},
                               .fix = {},
                               .side = Real(1),
                               .fixCosine = {},
                               .bsdf = BsdfInput<P>(scene.materials, at(scene.primitives->material))};
  const Vec3<Real> fix = -loadVec3(wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i);
  s.frame = Frame<Real>::fromNormal(s.normal);
  s.fixCosine = dot(fix, s.normal);
  s.fix = s.frame.toLocal(fix);
  const Mask twoSided = (s.bsdf.at(scene.materials->flags) & UInt(kTwoSided)) == UInt(kTwoSided);
  s.side = select(twoSided & (s.fix.z < Real(0)), Real(-1), Real(1));
  s.fix.z = s.fix.z * s.side;
  return s;
}

WAVECREST_SIMD_END
