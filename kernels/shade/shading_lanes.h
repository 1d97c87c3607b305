// The vertex of each lane as BSDFs want it: material, shading frame and the direction back along the path in it.
#pragma once

#include "kernels/bsdf/bsdf_lanes.h"
#include "kernels/simd/math.h"
#include "kernels/surface/normal_map_lanes.h"
#include "kernels/surface/surface_lanes.h"
#include "kernels/surface/vertex_detail_lanes.h"

WAVECREST_SIMD_BEGIN

// Scattering between `wi` and a direction at a vertex. Densities as in BsdfValue.
template <class Real>
struct Scattering {
  Vec3<Real> f;
  Real pdf, pdfReverse;
  Real lightCosine;  // c(omega_l) = |omega_l . N_s|, which f is multiplied by
};

// What a vertex is, before its material is known: of a live path, or of a stored light vertex.
template <class Real>
struct VertexLanes {
  Vec3<Real> position, wi, normal;  // geometric normal
  Real offset;
  UInt material;
  VertexDetailLanes<Real> details;
};

struct NoTangents {};

template <class P, uint32_t kFeatures>
struct ShadingLanes {
  using Real = typename P::Real;
  Vec3<Real> position, normal;
  Real offset;
  Frame<Real> frame;
  Vec3<Real> wi;  // in the frame, after turning a two-sided surface towards it
  Real side;      // -1 where a two-sided surface was turned, else 1
  Real wiCosine;  // wi . geometric normal, signed
  BsdfInputOf<P, kFeatures> bsdf;
  std::conditional_t<has(kFeatures, kNormalMaps), NormalMapLanes<Real>, NoNormalMaps> map;
  std::conditional_t<has(kFeatures, kCompoundBsdfs), Vec3<Real>, NoTangents>
      tangent;  // dp/du, if the scene asks for it

  // Without maps, textures and other sides yet. A constructor, because g++ first clears all of an aggregate in memory.
  WAVECREST_INLINE ShadingLanes(const VertexLanes<Real>& vertex, const BsdfInputOf<P, kFeatures>& input)
      : position(vertex.position),
        normal(vertex.normal),
        offset(vertex.offset),
        frame(Frame<Real>::fromNormal(vertex.details.normal)),
        wi(frame.toLocal(vertex.wi)),
        side(Real(1)),
        wiCosine(dot(vertex.wi, vertex.normal)),
        bsdf(input) {}

  // Between the world and the frame that wi is in: a turned surface flips z.
  WAVECREST_INLINE Vec3<Real> toLocal(Vec3<Real> v) const {
    const Vec3<Real> local = frame.toLocal(v);
    return {local.x, local.y, local.z * side};
  }
  WAVECREST_INLINE Vec3<Real> toWorld(Vec3<Real> v) const { return frame.toWorld({v.x, v.y, v.z * side}); }

  // By the lobes that are not deltas. The shading normal alone decides what f is, as in Mitsuba 3: where the geometric
  // normal has a direction on the other side, the ray goes through the surface.
  WAVECREST_INLINE Scattering<Real> scattering(Mask active, Vec3<Real> direction) const {
    const Vec3<Real> wo = toLocal(direction);
    const BsdfValue<Real> value = evalBsdf<P, kFeatures>(bsdf, active, wi, wo);
    Scattering<Real> out{value.f, value.pdf, value.pdfReverse, abs(bsdf.walk == Walk::camera ? wo.z : wi.z)};
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present) applyMap(active, direction, out);
    }
    return out;
  }

  // A direction to go on. wo is in this frame. On a light walk scatter multiplies the weight by quotients of cosines
  // (METHODS 3.9), which it takes from this frame. The weights of mapped lanes are such that the product has the
  // cosines to the normal that f is taken with.
  WAVECREST_INLINE BsdfSample<Real> sampled(Mask active, const Uniform4& u) const {
    Mask reflected = noLanes();
    return sampled(active, u, reflected);
  }
  // reflected: lanes whose two directions are on one side of the normal that was sampled with, which wo may not tell.
  WAVECREST_INLINE BsdfSample<Real> sampled(Mask active, const Uniform4& u, Mask& reflected) const {
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present && bsdf.walk == Walk::light) return sampledFromLight(active, u, reflected);
    }
    BsdfSample<Real> sample = sampleBsdf<P, kFeatures>(bsdf, active, wi, u);
    reflected = (wi.z * sample.wo.z) > Real(0);
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present) mapSampleFromEye(active, sample);
    }
    return sample;
  }

  // The probability with which a light walk that comes from `direction` samples with this frame's normal.
  WAVECREST_INLINE Real shareOfNormal([[maybe_unused]] Vec3<Real> direction) const {
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (map.present) return select(map.lanes, map.lightShare(frame.n, direction), Real(1));
    }
    return Real(1);
  }

 private:
  // The vertex with the other of its two normals (normal_map_lanes.h).
  struct View {
    Frame<Real> frame;
    Vec3<Real> wi;
    Real side;
    WAVECREST_INLINE Vec3<Real> toLocal(Vec3<Real> v) const {
      const Vec3<Real> local = frame.toLocal(v);
      return {local.x, local.y, local.z * side};
    }
    WAVECREST_INLINE Vec3<Real> toWorld(Vec3<Real> v) const { return frame.toWorld({v.x, v.y, v.z * side}); }
  };
  WAVECREST_INLINE View otherView() const {
    View view{Frame<Real>::fromNormal(map.otherOf(frame.n)), {}, Real(1)};
    view.wi = view.frame.toLocal(map.wi);
    const Mask twoSided = (bsdf.flags & UInt(kTwoSided)) == UInt(kTwoSided);
    view.side = select(twoSided & (view.wi.z < Real(0)), Real(-1), Real(1));
    view.wi.z = view.wi.z * view.side;
    return view;
  }
  // The BSDF with the direction of dp/du in the other view's frame, in the lanes of `other`.
  WAVECREST_INLINE decltype(auto) bsdfIn([[maybe_unused]] Mask other, [[maybe_unused]] const View& view) const {
    if constexpr (has(kFeatures, kCompoundBsdfs)) {
      BsdfInputOf<P, kFeatures> input = bsdf;
      if (bsdf.scene->tangents) {
        input.setTangent(tangent, view.frame);
        input.tangentX = select(other, input.tangentX, bsdf.tangentX);
        input.tangentY = select(other, input.tangentY, bsdf.tangentY);
      }
      return input;
    } else {
      return (bsdf);
    }
  }
  // The factor by which a map changes f between wi and `direction`. seesThis: lanes where the eye faces the normal of
  // this frame, not its mirror image.
  WAVECREST_INLINE Real lightFactor(Mask seesThis, Vec3<Real> direction) const {
    const Vec3<Real> seen = select(seesThis, frame.n, map.otherOf(frame.n));
    return bsdf.walk == Walk::camera ? map.lightFactor(seen, direction, map.wi)
                                     : map.lightFactor(seen, map.wi, direction);
  }

  // Turns `out`, which is scattering at this frame's normal, into that of a map with two normals, in mapped lanes
  // (METHODS 1.2). f is taken with the normal that the eye faces. The density of a light walk, pdf or pdfReverse, is
  // the mixture of those with either normal.
  WAVECREST_INLINE void applyMap(Mask active, Vec3<Real> direction, Scattering<Real>& out) const {
    const Mask mapped = active & map.lanes;
    if (none(mapped)) return;
    const bool camera = bsdf.walk == Walk::camera;
    // share: the probability that a light walk draws this frame's normal. both: lanes that need the other normal as
    // well.
    const Real one(1), share = map.lightShare(frame.n, camera ? direction : map.wi);
    const Mask seesThis = camera ? mapped : mapped & map.sees(direction, frame.n);
    const Mask both = andNot(mapped, seesThis & (share >= one));
    if (any(both)) {
      const View other = otherView();
      const BsdfValue<Real> value =
          evalBsdf<P, kFeatures>(bsdfIn(both, other), both, other.wi, other.toLocal(direction));
      const auto mixed = [&](Real a, Real b)
                             WAVECREST_LAMBDA { return select(both, a * share + b * (one - share), a); };
      if (camera) {
        out.pdfReverse = mixed(out.pdfReverse, value.pdfReverse);
      } else {
        const Mask seesOther = andNot(mapped, seesThis);
        out.f = select(seesOther, value.f, out.f);
        out.lightCosine = select(seesOther, abs(other.wi.z), out.lightCosine);
        out.pdfReverse = select(seesOther, value.pdfReverse, out.pdfReverse);
        out.pdf = mixed(out.pdf, value.pdf);
      }
    }
    out.f = select(mapped, out.f * lightFactor(seesThis, direction), out.f);
  }

  // Lanes that went straight on through a pane, not through an absent surface, which has no normal.
  static WAVECREST_INLINE Mask throughPane(const BsdfSample<Real>& sample, Vec3<Real> from) {
    const Mask straight = (sample.wo.x == -from.x) & (sample.wo.y == -from.y) & (sample.wo.z == -from.z);
    return andNot(straight & sample.specular, sample.absent);
  }

  // A camera walk samples with this frame's normal, which is the one that the eye faces.
  WAVECREST_INLINE void mapSampleFromEye(Mask active, BsdfSample<Real>& sample) const {
    const Mask mapped = andNot(active & map.lanes, sample.absent);
    if (none(mapped)) return;
    // The reverse walk comes from a light. Through a delta lobe it takes this way only if it draws this normal; other
    // lobes have the density of the mixture.
    const Vec3<Real> direction = toWorld(sample.wo);
    const Mask finite = andNot(mapped, sample.specular);
    const Real back = sample.pdfReverse * map.lightShare(frame.n, direction);
    sample.pdfReverse = select(mapped, back, sample.pdfReverse);
    if (any(finite)) sample.pdfReverse = select(finite, scattering(finite, direction).pdfReverse, sample.pdfReverse);
    // What a pane lets through is not dimmed: the light is right behind.
    const Mask dimmed = andNot(mapped, throughPane(sample, wi));
    sample.weight = select(dimmed, sample.weight * lightFactor(dimmed, direction), sample.weight);
  }

  // A light walk draws one of the two normals and samples with it.
  WAVECREST_INLINE BsdfSample<Real> sampledFromLight(Mask active, const Uniform4& u, Mask& reflected) const {
    const Real one(1), tiny(1e-12f);
    // Draw the normal by u.b.
    const View other = otherView();
    const Real share = select(map.lanes, map.lightShare(frame.n, map.wi), one);
    const Mask drawsOther = active & (to<Real>(u.b) >= share);
    const Real drawn = select(drawsOther, one - share, share);
    // What is left of u.b chooses the direction.
    const Float rest = toFloat(select(drawsOther, to<Real>(u.b) - share, to<Real>(u.b)) / drawn);
    const Uniform4 numbers{u.a, min(max(rest, Float(0)), Float(0x1.fffffep-1f)), u.c, u.d};
    // Sample in the frame of the drawn normal. wo is the result in this frame.
    const Vec3<Real> from = select(drawsOther, other.wi, wi);
    BsdfSample<Real> sample = sampleBsdf<P, kFeatures>(bsdfIn(drawsOther, other), active, from, numbers);
    reflected = (from.z * sample.wo.z) > Real(0);
    const Mask mapped = andNot(active & map.lanes, sample.absent);
    const Vec3<Real> direction = select(drawsOther, other.toWorld(sample.wo), toWorld(sample.wo));
    const Vec3<Real> wo = select(drawsOther, toLocal(direction), sample.wo);

    const Mask seesThis = mapped & map.sees(direction, frame.n);
    // A delta lobe joins its two directions by the drawn normal alone, which must be the one that the eye faces.
    const Mask delta = mapped & sample.specular, joins = andNot(drawsOther, seesThis) | andNot(seesThis, drawsOther);
    const Real turn = abs(from.z * wo.z) / max(abs(sample.wo.z * wi.z), tiny);  // of cosines to this frame's
    const Real dimming = select(throughPane(sample, from), one, lightFactor(seesThis, direction));
    const Real factor = zeroUnless(joins, turn * dimming / drawn);
    sample.weight = select(delta, sample.weight * factor, sample.weight);
    sample.pdfReverse = select(delta, sample.pdfReverse * turn, sample.pdfReverse);
    sample.pdf = select(delta, sample.pdf * drawn, sample.pdf);

    // Other lobes: either normal may have led to this direction, so weight and densities come from scattering(). The
    // quotient of cosines to this frame undoes that of scatter. A draw that failed keeps its weight of zero, as the
    // density counts only draws that succeed.
    const Mask finite = andNot(mapped, sample.specular), made = sample.pdf > Real(0);
    if (any(finite)) {
      const Scattering<Real> all = scattering(finite, direction);
      const Real scale = all.lightCosine * abs(wo.z) / max(abs(wi.z) * all.pdf, tiny);
      sample.weight = select(finite, zeroUnless(made, all.f * scale), sample.weight);
      sample.pdfReverse = select(finite, all.pdfReverse, sample.pdfReverse);
      sample.pdf = select(finite, all.pdf, sample.pdf);
    }
    sample.wo = wo;
    return sample;
  }
};

template <class S>
WAVECREST_INLINE UInt materialOf(const SceneView<S>& scene, UInt primitive) {
  return primitivesOf(scene, primitive)(scene.primitives->material);
}

// The vertex in its shading frame, with its material, textures and map, turned towards wi where it is two-sided.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> shadingOf(const SceneView<typename P::Storage>& scene,
                                                      const VertexLanes<typename P::Real>& vertex) {
  using Real = typename P::Real;
  ShadingLanes<P, kFeatures> s(vertex, BsdfInputOf<P, kFeatures>(scene, vertex.material));
  const auto flagged = [&](MaterialFlags flag) WAVECREST_LAMBDA { return (s.bsdf.flags & UInt(flag)) == UInt(flag); };
  if constexpr (has(kFeatures, kNormalMaps)) {
    if (scene.normalMaps && any(flagged(kMapped))) {
      s.map = {.present = true,
               .lanes = flagged(kMapped),
               .flips = flagged(kFlipsNormals),
               .softens = flagged(kSoftensTerminator),
               .mirrorsBack = flagged(kMirrorsBack),
               .wi = vertex.wi,
               .base = vertex.details.base,
               .mapped = vertex.details.normal};
      // Of the two normals of a map the frame has the one that wi faces.
      s.frame = Frame<Real>::fromNormal(select(s.map.lanes, s.map.normalFor(vertex.wi), vertex.details.normal));
      s.wi = s.frame.toLocal(vertex.wi);
    }
  }
  if constexpr (has(kFeatures, kTextures)) {
    readTextureFactors<P>(scene, s.bsdf, vertex.details.u, vertex.details.v);
  }
  if constexpr (has(kFeatures, kCompoundBsdfs)) {
    s.bsdf.u = vertex.details.u;
    s.bsdf.v = vertex.details.v;
    if (scene.tangents) {
      // dp/du from its angle about the base normal.
      const auto base = Frame<Real>::fromNormal(scene.normalMaps ? vertex.details.base : vertex.details.normal);
      const auto angle = sinCos(to<Real>(vertex.details.tangent));
      s.tangent = mulAdd(base.s, angle.cos, base.t * angle.sin);
      s.bsdf.setTangent(s.tangent, s.frame);
    }
  }
  s.side = select(flagged(kTwoSided) & (s.wi.z < Real(0)), Real(-1), Real(1));
  s.wi.z = s.wi.z * s.side;
  return s;
}

// The details of a vertex that has this geometric normal. columns: a record of vertices; read(column): the numbers of
// the lanes.
template <uint32_t kFeatures, class Real, class Columns, class Read>
WAVECREST_INLINE VertexDetailLanes<Real> readDetails(const Columns& columns, Vec3<Real> normal, const Read& read) {
  VertexDetailLanes<Real> details(normal);
  details.template read<kFeatures>(columns, read);
  return details;
}

// Block i of the live paths' vertices.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> loadShading(const SceneView<typename P::Storage>& scene,
                                                        const Wave<typename P::Storage>& wave, Mask active, size_t i) {
  using Real = typename P::Real;
  const auto& rays = wave.rays;
  const auto& surfaces = wave.surfaces;
  const auto normal = loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i);
  const VertexLanes<Real> vertex{
      .position = loadVec3(rays.originX, rays.originY, rays.originZ, i),
      .wi = -loadVec3(rays.directionX, rays.directionY, rays.directionZ, i),
      .normal = normal,
      .offset = load(surfaces.offset, i),
      .material = materialOf(scene, select(active, load(wave.hits.primitive, i), UInt(0u))),
      .details = readDetails<kFeatures>(surfaces, normal,
                                        [&](const auto& column) WAVECREST_LAMBDA { return load(column, i); })};
  return shadingOf<P, kFeatures>(scene, vertex);
}

WAVECREST_SIMD_END
