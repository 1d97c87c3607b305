// Vertex attributes at a surface point: texture coordinates, and the shading normal with bump and normal maps applied.
#pragma once

#include "kernels/simd/math.h"
#include "kernels/surface/instance_lanes.h"
#include "kernels/surface/texture_lanes.h"
#include "kernels/surface/vertex_detail_lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// Derivatives of the position by the texture coordinates.
template <class Real>
struct Tangents {
  Vec3<Real> dpDu, dpDv;
};

// n' of a height field over the surface: the normal of p + h n (Blinn 1978), on the side of the geometric normal.
template <class Real>
WAVECREST_INLINE Vec3<Real> bumped(const TextureRecord* textures, const float* texels, UInt id, Real scale, Float u,
                                   Float v, Vec3<Real> normal, Vec3<Real> geometric, const Tangents<Real>& tangents) {
  const TextureSlopes slopes = textureSlopes(textures, texels, id, u, v);
  const Real hu = to<Real>(slopes.u) * scale, hv = to<Real>(slopes.v) * scale;
  // The tangents of p + h n: along the normal they have the slope of h and nothing else.
  const Vec3<Real> du = mulAdd(normal, hu - dot(normal, tangents.dpDu), tangents.dpDu);
  const Vec3<Real> dv = mulAdd(normal, hv - dot(normal, tangents.dpDv), tangents.dpDv);
  // Of unit vectors, whose products stay in range whatever the scene's scale.
  const Vec3<Real> across = cross(normalize(du), normalize(dv));
  const Real square = length2(across);
  return select(square > Real(1e-30f), across * (copySign(Real(1), dot(across, geometric)) / sqrt(square)), normal);
}

// A normal read from a map, in the frame of the surface and its u direction. The surface's own where the map has none.
template <class Real>
WAVECREST_INLINE Vec3<Real> mapped(const TextureRecord* textures, const float* texels, UInt id, Float u, Float v,
                                   Vec3<Real> normal, const Tangents<Real>& tangents) {
  // From colours in [0, 1] to coordinates in [-1, 1].
  const Vec3<Real> local =
      to<Real>(evalTexture(textures, texels, id, u, v)) * Real(2) - Vec3<Real>{Real(1), Real(1), Real(1)};
  const Vec3<Real> s = normalize(mulAdd(normal, -dot(normal, tangents.dpDu), tangents.dpDu));
  const Vec3<Real> t = cross(normal, s);
  const Vec3<Real> turned = mulAdd(s, local.x, mulAdd(t, local.y, normal * local.z));
  return select(length2(turned) > Real(1e-12f), normalize(turned), normal);
}

}  // namespace

namespace {

// Texture coordinates of a sphere and their tangents (Mitsuba's `sphere`): the angles of the outward direction about
// the axis that its record has in e2, from the direction in `normal`, turning to e1.z (+1 or -1) times their product.
template <class P>
WAVECREST_INLINE void mapSphere(const PrimitiveRecord<typename P::Storage>& fields,
                                const PrimitiveLanes<typename P::Storage>& at, Mask sphere,
                                Vec3<typename P::Real> normal, VertexDetailLanes<typename P::Real>& out,
                                Tangents<typename P::Real>& tangents) {
  using Real = typename P::Real;
  // x, y, z: the outward direction in the sphere's own frame.
  const Vec3<Real> e1 = at(fields.e1), axis = at(fields.e2), phi0 = at(fields.normal);
  const Vec3<Real> outward = normal * e1.y, phi90 = cross(axis, phi0) * e1.z;
  const Real x = dot(outward, phi0), y = dot(outward, phi90), z = min(max(dot(outward, axis), Real(-1)), Real(1));
  const Real turn = atan2(y, x) * Real(kInvPi / 2);
  // The sine of the angle from the axis, bounded so that nothing is divided by 0 at the poles.
  const Real sine = sqrt(max(Real(1) - z * z, Real(1e-12f)));
  const Vec3<Real> outOfAxis = (phi0 * x + phi90 * y) * (Real(1) / sine);
  out.u = select(sphere, to<Float>(turn - floor(turn)), out.u);
  out.v = select(sphere, to<Float>(acos(z) * Real(kInvPi)), out.v);
  tangents.dpDu = select(sphere, (phi90 * x - phi0 * y) * (e1.x * Real(2 * kPi)), tangents.dpDu);
  tangents.dpDv = select(sphere, (outOfAxis * z - axis * sine) * (e1.x * Real(kPi)), tangents.dpDv);
}

// Normals, texture coordinates and tangents of the attributed lanes, from those of their corners. surface: in the space
// of the primitive's group. tangents: the edges of the primitive before.
template <class S, class Real>
WAVECREST_INLINE void interpolateCorners(const SceneView<S>& scene, Mask attributed, UInt index,
                                         const SurfacePoint<Real>& surface, VertexDetailLanes<Real>& out,
                                         Tangents<Real>& tangents) {
  const Real b1 = surface.u, b2 = surface.v, b0 = Real(1) - b1 - b2;
  const AttributeRecord& fields = *scene.attributes;
  const RecordLanes<AttributeRecord> corner(scene.attributes, select(attributed, index, UInt(0u)));
  // Normals and texture coordinates of the corners (0, 0), (1, 0) and (0, 1), interpolated. In the far half of a quad
  // b0 is negative.
  const Vec3<Real> smooth = to<Real>(corner(fields.normal[0])) * b0 + to<Real>(corner(fields.normal[1])) * b1 +
                            to<Real>(corner(fields.normal[2])) * b2;
  const Mask smoothed = attributed & (corner(fields.hasNormals) == UInt(1u)) & (length2(smooth) > Real(1e-12f));
  out.normal = select(smoothed, normalize(smooth), out.normal);

  Real uv[3][2];
  for (size_t k = 0; k < 3; ++k) {
    for (size_t axis = 0; axis < 2; ++axis) uv[k][axis] = to<Real>(corner(fields.uv[k][axis]));
  }
  out.u = select(attributed, to<Float>(uv[0][0] * b0 + uv[1][0] * b1 + uv[2][0] * b2), out.u);
  out.v = select(attributed, to<Float>(uv[0][1] * b0 + uv[1][1] * b1 + uv[2][1] * b2), out.v);
  // Solve (e1, e2) = (dpDu, dpDv) . d(u, v) for the tangents.
  const Real u1 = uv[1][0] - uv[0][0], v1 = uv[1][1] - uv[0][1], u2 = uv[2][0] - uv[0][0], v2 = uv[2][1] - uv[0][1];
  const Real determinant = u1 * v2 - u2 * v1;
  const Mask spans = attributed & (abs(determinant) > Real(1e-20f));
  const Real inverse = Real(1) / select(spans, determinant, Real(1));
  const Vec3<Real> e1 = tangents.dpDu, e2 = tangents.dpDv;
  tangents.dpDu = select(spans, (e1 * v2 - e2 * v1) * inverse, e1);
  tangents.dpDv = select(spans, (e2 * u1 - e1 * u2) * inverse, e2);
  // Where they do not span the plane of the coordinates, Mitsuba takes any frame of the face.
  const Mask folded = andNot(attributed, spans);
  if (any(folded)) {
    const auto face = Frame<Real>::fromNormal(surface.normal);
    tangents.dpDu = select(folded, face.s, tangents.dpDu);
    tangents.dpDv = select(folded, face.t, tangents.dpDv);
  }
}

// Bump and normal maps change the normal; `base` stays as it is.
template <class S, class Real>
WAVECREST_INLINE void mapNormals(const SceneView<S>& scene, const PrimitiveLanes<S>& at, Mask hit, Vec3<Real> geometric,
                                 const Tangents<Real>& tangents, VertexDetailLanes<Real>& out) {
  const MaterialLanes material(scene, at(scene.primitives->material));
  const UInt bumpMap = material(scene.materials->bumpTexture), normalMap = material(scene.materials->normalTexture);
  const Mask bump = andNot(hit, bumpMap == UInt(kNoIndex)), map = andNot(hit, normalMap == UInt(kNoIndex));
  if (any(bump)) {
    const Real scale = to<Real>(material(scene.materials->bumpScale));
    out.normal = select(bump,
                        bumped(scene.textures, scene.texels, select(bump, bumpMap, UInt(0u)), scale, out.u, out.v,
                               out.normal, geometric, tangents),
                        out.normal);
  }
  if (any(map)) {
    out.normal = select(
        map, mapped(scene.textures, scene.texels, select(map, normalMap, UInt(0u)), out.u, out.v, out.normal, tangents),
        out.normal);
  }
}

}  // namespace

// Shading normal, texture coordinates and tangent at a surface point, in the world. surface: in the space of the
// primitive's group. geometric: its normal in the world.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE VertexDetailLanes<typename P::Real> interpolate(const SceneView<typename P::Storage>& scene,
                                                                 const PrimitiveLanes<typename P::Storage>& at,
                                                                 Mask hit,
                                                                 const SurfacePoint<typename P::Real>& surface,
                                                                 Vec3<typename P::Real> geometric,
                                                                 const InstanceLanes<P, kFeatures>& instance) {
  using Real = typename P::Real;
  // A primitive without attributes has its own normal, and its own (u, v) as texture coordinates.
  VertexDetailLanes<Real> out(surface.normal);
  out.u = to<Float>(surface.u);
  out.v = to<Float>(surface.v);
  const UInt index = at(scene.primitives->attributes);
  const Mask attributed = andNot(hit, index == UInt(kNoIndex));
  Tangents<Real> tangents{at(scene.primitives->e1), at(scene.primitives->e2)};

  if (scene.attributes != nullptr && any(attributed)) {
    interpolateCorners(scene, attributed, index, surface, out, tangents);
  }

  if constexpr (has(kFeatures, kTextures) && has(kFeatures, kCurvedShapes)) {
    if (scene.spheres) {
      const Mask sphere = hit & (at(scene.primitives->kind) == UInt(static_cast<uint32_t>(PrimitiveKind::sphere)));
      if (any(sphere)) mapSphere<P>(*scene.primitives, at, sphere, surface.normal, out, tangents);
    }
  }

  if constexpr (has(kFeatures, kInstances)) {
    // From the group to the world.
    out.normal = instance.normalToWorld(out.normal);
    tangents = {instance.vectorToWorld(tangents.dpDu), instance.vectorToWorld(tangents.dpDv)};
  }
  out.base = out.normal;
  if constexpr (has(kFeatures, kCompoundBsdfs)) {
    if (scene.tangents) {
      const auto frame = Frame<Real>::fromNormal(out.base);
      out.tangent = to<Float>(atan2(dot(tangents.dpDu, frame.t), dot(tangents.dpDu, frame.s)));
    }
  }
  if (has(kFeatures, kNormalMaps) && scene.normalMaps) mapNormals(scene, at, hit, geometric, tangents, out);
  return out;
}

WAVECREST_SIMD_END
