// Between the space of the group that a hit's primitive is in and the world.
//
// A point's error in the world along the normal is that which it has in the group, divided by the length of the
// transformed normal: toObject^T turns a unit normal n of the group into |toObject^T n| times one of the world, and
// moving a point by d there moves it by n . d / |toObject^T n| along the world's. The ways there and back round as well
// (kernels/extend/placed_rays.h), as the transform and its inverse stretch the point's coordinates.
#pragma once

#include "kernels/surface/surface_lanes.h"

WAVECREST_SIMD_BEGIN

// Of feature sets without instances, where everything is in the world, this is empty and its functions change nothing.
template <class P, uint32_t kFeatures>
class InstanceLanes {
 public:
  using Real = typename P::Real;
  using S = typename P::Storage;

  // hit: lanes of block i that met a primitive.
  WAVECREST_INLINE InstanceLanes(const SceneView<S>&, const Hits&, size_t, Mask) {}
  WAVECREST_INLINE Vec3<Real> pointToGroup(Vec3<Real> p) const { return p; }
  WAVECREST_INLINE Vec3<Real> vectorToGroup(Vec3<Real> v) const { return v; }
  WAVECREST_INLINE Vec3<Real> vectorToWorld(Vec3<Real> v) const { return v; }
  WAVECREST_INLINE Vec3<Real> normalToWorld(Vec3<Real> n) const { return n; }
  WAVECREST_INLINE const SurfacePoint<Real>& toWorld(const SurfacePoint<Real>& surface) const { return surface; }
};

template <class P, uint32_t kFeatures>
requires(has(kFeatures, kInstances)) class InstanceLanes<P, kFeatures> {
 public:
  using Real = typename P::Real;
  using S = typename P::Storage;

  WAVECREST_INLINE InstanceLanes(const SceneView<S>& scene, const Hits& hits, size_t i, Mask hit) : placed_(noLanes()) {
    if (scene.instances == nullptr) return;
    const UInt index = load(hits.instance, i);
    placed_ = andNot(hit, index == UInt(kNoIndex));
    if (none(placed_)) return;
    const RecordLanes<InstanceRecord<S>> at(scene.instances, select(placed_, index, UInt(0u)));
    place_ = at(scene.instances->place);
    for (size_t row = 0; row < 3; ++row) {
      toWorld_[row] = at(scene.instances->toWorld[row]);
      toGroup_[row] = at(scene.instances->toObject[row]);
    }
  }
  WAVECREST_INLINE Vec3<Real> pointToGroup(Vec3<Real> p) const {
    return none(placed_) ? p : select(placed_, product(toGroup_, p - place_), p);
  }
  WAVECREST_INLINE Vec3<Real> vectorToGroup(Vec3<Real> v) const {
    return none(placed_) ? v : select(placed_, product(toGroup_, v), v);
  }
  WAVECREST_INLINE Vec3<Real> vectorToWorld(Vec3<Real> v) const {
    return none(placed_) ? v : select(placed_, product(toWorld_, v), v);
  }
  // Unit normals.
  WAVECREST_INLINE Vec3<Real> normalToWorld(Vec3<Real> n) const {
    return none(placed_) ? n : select(placed_, normalize(covector(n)), n);
  }
  WAVECREST_INLINE SurfacePoint<Real> toWorld(const SurfacePoint<Real>& surface) const {
    if (none(placed_)) return surface;
    constexpr double kPassageGamma = 8 * kUnitRoundoff;
    const Vec3<Real> normal = covector(surface.normal);
    const Real inverseLength = Real(1) / sqrt(length2(normal));
    SurfacePoint<Real> out = surface;
    out.normal = select(placed_, normal * inverseLength, surface.normal);
    out.position = select(placed_, product(toWorld_, surface.position) + place_, surface.position);
    // Bounds of the rounding in the group and in the world.
    const Vec3<Real> stretched = sizes(toWorld_, surface.position);
    const Vec3<Real> andBack = sizes(toGroup_, stretched), extent = stretched + abs(place_);
    const Real there = mulAdd(dot(abs(surface.normal), andBack), Real(kPassageGamma), surface.offset) * inverseLength;
    const Real here = dot(abs(out.normal), extent) * Real(kPassageGamma);
    const Real least = maxComponent(extent) * Real(4 * kUnitRoundoff);
    out.offset = select(placed_, max(there + here, least), surface.offset);
    return out;
  }

 private:
  static WAVECREST_INLINE Vec3<Real> product(const Vec3<Real> (&rows)[3], Vec3<Real> v) {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
  // Of the matrix and vector of absolute values.
  static WAVECREST_INLINE Vec3<Real> sizes(const Vec3<Real> (&rows)[3], Vec3<Real> v) {
    const Vec3<Real> size = abs(v);
    return {dot(abs(rows[0]), size), dot(abs(rows[1]), size), dot(abs(rows[2]), size)};
  }
  WAVECREST_INLINE Vec3<Real> covector(Vec3<Real> n) const {
    return mulAdd(toGroup_[0], n.x, mulAdd(toGroup_[1], n.y, toGroup_[2] * n.z));
  }

  Mask placed_;  // lanes within an instance
  Vec3<Real> place_, toWorld_[3], toGroup_[3];
};

WAVECREST_SIMD_END
