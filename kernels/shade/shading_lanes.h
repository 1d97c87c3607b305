// The vertex of each lane as BSDFs want it: material, shading frame and the direction back along the path in it.
#pragma once

#include "kernels/shade/bsdf_lanes.h"
#include "kernels/shade/normal_map_lanes.h"
#include "kernels/shade/surface_lanes.h"
#include "kernels/shade/texture_lanes.h"

WAVECREST_SIMD_BEGIN

// Scattering between `fix` and a direction at a vertex. Densities as in BsdfValue.
template <class Real>
struct Scattering {
  Vec3<Real> f;
  Real pdf, pdfReverse;
  Real lightCosine;  // c(omega_l) = |omega_l . N_s|, which f is multiplied by
};

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
  std::conditional_t<has(kFeatures, kNormalMaps), NormalMapLanes<Real>, NoNormalMaps> map;

  WAVECREST_INLINE Vec3<Real> toLocal(Vec3<Real> v) const {
    const Vec3<Real> local = frame.toLocal(v);
    return {local.x, local.y, local.z * side};
  }
  WAVECREST_INLINE Vec3<Real> toWorld(Vec3<Real> v) const { return frame.toWorld({v.x, v.y, v.z * side}); }

  // By the lobes that are not deltas. The shading normal alone decides what f is, as in Mitsuba 3: where the geometric
  // normal has a direction on the other side, the ray goes through the surface.
  WAVECREST_INLINE Scattering<Real> scattering(Mask active, Vec3<Real> direction) const {
    const Vec3<Real> gen = toLocal(direction);
    const BsdfValue<Real> value = evalBsdf<P, kFeatures>(bsdf, active, fix, gen);
    Scattering<Real> out{value.f, value.pdf, value.pdfReverse, abs(bsdf.walk == Walk::camera ? gen.z : fix.z)};
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present) applyMap(active, direction, out);
    }
    return out;
  }

  // A direction to go on.
  WAVECREST_INLINE BsdfSample<Real> sampled(Mask active, const Uniform4& u) const {
    BsdfSample<Real> sample = sampleBsdf<P, kFeatures>(bsdf, active, fix, u);
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present) applyMap(active, sample);
    }
    return sample;
  }

 private:
  // The same vertex as a walk that comes from `direction` samples it, with fix and gen as here.
  struct OtherEnd {
    Mask differs;  // in whose normal
    BsdfValue<Real> value;
    Vec3<Real> normal;
    Real fixZ;
  };
  WAVECREST_INLINE OtherEnd otherEnd(Mask mapped, Vec3<Real> direction) const {
    OtherEnd out{noLanes(), zeroBsdfValue<Real>(), map.normalFor(direction), fix.z};
    out.differs =
        andNot(mapped, (out.normal.x == frame.n.x) & (out.normal.y == frame.n.y) & (out.normal.z == frame.n.z));
    if (none(out.differs)) return out;
    const Frame<Real> turned = Frame<Real>::fromNormal(out.normal);
    Vec3<Real> gen = turned.toLocal(direction), back = turned.toLocal(map.fix);
    const Real turnedSide = select(isTwoSided() & (gen.z < Real(0)), Real(-1), Real(1));
    gen.z = gen.z * turnedSide;
    back.z = back.z * turnedSide;
    out.value = evalBsdf<P, kFeatures>(bsdf, out.differs, back, gen);
    out.fixZ = back.z;
    return out;
  }
  WAVECREST_INLINE Mask isTwoSided() const {
    return (bsdf.at(bsdf.materials->flags) & UInt(kTwoSided)) == UInt(kTwoSided);
  }
  WAVECREST_INLINE Real lightFactor(const OtherEnd& other, Vec3<Real> direction) const {
    return bsdf.walk == Walk::camera ? map.lightFactor(frame.n, direction, map.fix)
                                     : map.lightFactor(other.normal, map.fix, direction);
  }

  WAVECREST_INLINE void applyMap(Mask active, Vec3<Real> direction, Scattering<Real>& out) const {
    const Mask mapped = active & map.lanes;
    const OtherEnd other = otherEnd(mapped, direction);
    out.pdfReverse = select(other.differs, other.value.pdfReverse, out.pdfReverse);
    if (bsdf.walk == Walk::light) {
      out.f = select(other.differs, other.value.f, out.f);
      out.lightCosine = select(other.differs, abs(other.fixZ), out.lightCosine);
    }
    out.f = select(mapped, out.f * lightFactor(other, direction), out.f);
  }

  // A delta lobe joins the two directions that one normal does: where the other end has another normal, it never comes
  // back this way, and from a light there is no f.
  WAVECREST_INLINE void applyMap(Mask active, BsdfSample<Real>& sample) const {
    const Vec3<Real> direction = toWorld(sample.gen);
    const Mask passes = (sample.gen.x == -fix.x) & (sample.gen.y == -fix.y) & (sample.gen.z == -fix.z);
    const Mask mapped = andNot(active & map.lanes, sample.specular & passes);
    const OtherEnd other = otherEnd(mapped, direction);
    sample.pdfReverse = select(other.differs, zeroUnless(!sample.specular, other.value.pdfReverse), sample.pdfReverse);
    if (bsdf.walk == Walk::light) {  // scatter turns the weight's |cos gen| into the light's cosine, by this frame
      const Real scale = abs(sample.gen.z * other.fixZ) / (max(abs(fix.z), Real(1e-12f)) * sample.pdf);
      sample.weight = select(other.differs, zeroUnless(!sample.specular, other.value.f * scale), sample.weight);
    }
    sample.weight = select(mapped, sample.weight * lightFactor(other, direction), sample.weight);
  }
};

// What a vertex is, before its material is known: of a live path, or of a stored light vertex.
template <class Real>
struct VertexLanes {
  Vec3<Real> position, fix, normal, shadingNormal;
  Vec3<Real> baseNormal;  // the shading normal without its map, in feature sets with normal maps
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
                               .bsdf = BsdfInputOf<P, kFeatures>(scene.materials, at(scene.primitives->material)),
                               .map = {}};
  const UInt flags = s.bsdf.at(scene.materials->flags);
  const auto flagged = [&](MaterialFlags flag) HWY_ATTR { return (flags & UInt(flag)) == UInt(flag); };
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps && any(flagged(kMapped))) {
      s.map = {.present = true,
               .lanes = flagged(kMapped),
               .flips = flagged(kFlipsNormals),
               .softens = flagged(kSoftensTerminator),
               .mirrorsBack = flagged(kMirrorsBack),
               .fix = vertex.fix,
               .base = vertex.baseNormal,
               .mapped = vertex.shadingNormal};
      s.frame = Frame<Real>::fromNormal(select(s.map.lanes, s.map.normalFor(vertex.fix), vertex.shadingNormal));
    }
  }
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
  s.side = select(flagged(kTwoSided) & (s.fix.z < Real(0)), Real(-1), Real(1));
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
                           .baseNormal = {},
                           .offset = load(surfaces.offset, i),
                           .u = Float(0),
                           .v = Float(0),
                           .primitive = select(active, load(wave.hits.primitive, i), UInt(0u))};
  vertex.shadingNormal = vertex.normal;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = loadVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, i);
  }
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps) vertex.baseNormal = loadVec3(surfaces.baseX, surfaces.baseY, surfaces.baseZ, i);
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
                           .baseNormal = {},
                           .offset = gather(surfaces.offset, index),
                           .u = Float(0),
                           .v = Float(0),
                           .primitive = gather(wave.hits.primitive, index)};
  vertex.shadingNormal = vertex.normal;
  if constexpr (has(kFeatures, kShadingNormals)) {
    vertex.shadingNormal = gatherVec3(surfaces.shadingX, surfaces.shadingY, surfaces.shadingZ, index);
  }
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps) vertex.baseNormal = gatherVec3(surfaces.baseX, surfaces.baseY, surfaces.baseZ, index);
  }
  if constexpr (has(kFeatures, kTextures)) {
    vertex.u = gather(surfaces.uvU, index);
    vertex.v = gather(surfaces.uvV, index);
  }
  return shadingOf<P, kFeatures>(scene, vertex);
}

WAVECREST_SIMD_END
