// Tests of one primitive against a block of rays, for the small-scene intersector, and of one ray against all leaves.
#pragma once

#include "kernels/extend/bvh_ray.h"
#include "kernels/extend/small_scene.h"
#include "kernels/extend/sphere_lanes.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// 1 to 2 ulp at most, and the same bits on every processor: the guesses of SSE and AVX2 differ by maker, those of
// AVX-512 are defined.
WAVECREST_INLINE Float repeatableReciprocal(Float a) {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2
  return Float(1) / a;
#else
  return approximateReciprocal(a);
#endif
}

WAVECREST_INLINE Float dotForm(const float (&a)[3], Vec3<Float> b) {
  return mulAdd(Float(a[0]), b.x, mulAdd(Float(a[1]), b.y, Float(a[2]) * b.z));
}
WAVECREST_INLINE Float dotForm(const float (&a)[3], Vec3<Float> b, float offset) {
  return mulAdd(Float(a[0]), b.x, mulAdd(Float(a[1]), b.y, mulAdd(Float(a[2]), b.z, Float(offset))));
}

// Inside where edge <= 1, up to the bound limit - 1 on the error of edge.
struct PlaneHit {
  Float t, edge, limit;
};

// Where the rays meet the plane. A ray within the plane gives NaN or infinity, which fails every comparison that
// follows. kQuad: or a triangle. |direction| <= 1.
template <bool kQuad>
WAVECREST_INLINE PlaneHit intersectPlane(const PlaneForm& plane, const PlaneLimits& limits, Vec3<Float> origin,
                                         Vec3<Float> direction) {
  const Float speed = dotForm(plane.normal, direction);
  const Float gap = negMulAdd(
      Float(plane.normal[0]), origin.x,
      negMulAdd(Float(plane.normal[1]), origin.y, negMulAdd(Float(plane.normal[2]), origin.z, Float(plane.distance))));
  PlaneHit hit;
  const Float inverseSpeed = repeatableReciprocal(speed);
  hit.t = gap * inverseSpeed;
  const Vec3<Float> point = mulAdd(direction, hit.t, origin);
  const Float u = dotForm(plane.inside.uAxis, point, plane.inside.uOffset);
  const Float v = dotForm(plane.inside.vAxis, point, plane.inside.vOffset);
  hit.edge = kQuad ? max(abs(u), abs(v)) : max(max(u, v), Float(2) - u - v);
  hit.limit = mulAdd(abs(inverseSpeed), Float(limits.doubt), Float(1));
  return hit;
}

// ---- boxes ----------------------------------------------------------------------------------------------------------

// Added to the speed across a slab, so that a ray along it has a finite t, beyond every other that matters, and 0 where
// it starts in one of the slab's planes: then no comparison sees a NaN.
constexpr float kParallelSpeed = 1e-20f;

// Where the rays meet the two planes of a slab.
struct SlabHit {
  Float low, high;
};
WAVECREST_INLINE SlabHit intersectSlab(const SlabForm& slab, Vec3<Float> origin, Vec3<Float> direction) {
  const Float inverse = repeatableReciprocal(dotForm(slab.normal, direction, kParallelSpeed));
  const Float along = dotForm(slab.normal, origin);
  return {(Float(slab.low) - along) * inverse, (Float(slab.high) - along) * inverse};
}

struct BoxHit {
  Mask hit;  // some face is met at t, which may be behind the origin
  Float t;
  UInt primitive;
};

// The first face that the rays meet: where they enter the box, or if that is behind them or missing, where they leave.
template <bool kOpen>
WAVECREST_INLINE BoxHit intersectBox(const BoxForm& box, Vec3<Float> origin, Vec3<Float> direction) {
  const SlabHit a = intersectSlab(box.slabs[0], origin, direction);
  const SlabHit b = intersectSlab(box.slabs[1], origin, direction);
  const SlabHit c = intersectSlab(box.slabs[2], origin, direction);
  const Float enter = max(max(min(a.low, a.high), min(b.low, b.high)), min(c.low, c.high));
  const Float leave = min(min(max(a.low, a.high), max(b.low, b.high)), max(c.low, c.high));
  Mask entering = enter > Float(0), hit = enter <= leave;
  if constexpr (kOpen) {
    entering = andNot(entering, enter == c.high);
    hit = hit & (entering | !(leave == c.high));
  }
  const Float t = select(entering, enter, leave);
  // On an edge two planes are met at the same t, and the last of these decides.
  UInt primitive(box.primitives[2][0]);
  const auto at = [&](Float plane, uint32_t face)
                      WAVECREST_LAMBDA { primitive = select(t == plane, UInt(face), primitive); };
  if constexpr (!kOpen) at(c.high, box.primitives[2][1]);
  at(b.high, box.primitives[1][1]);
  at(b.low, box.primitives[1][0]);
  at(a.high, box.primitives[0][1]);
  at(a.low, box.primitives[0][0]);
  return {hit, t, primitive};
}

// ---- solids ---------------------------------------------------------------------------------------------------------

constexpr float kUnbounded = 3.0e38f;

// Where rays are inside of all planes that were taken so far: from the last that they enter by to the first that they
// leave by.
struct Inside {
  Float enter, leave;
  UInt enterFace, leaveFace;

  WAVECREST_INLINE Inside() : enter(-kUnbounded), leave(kUnbounded), enterFace(kMiss), leaveFace(kMiss) {}

  // A ray along the plane leaves it far ahead, or where it lies outside, far behind.
  template <bool kShared>
  WAVECREST_INLINE void take(const SidePlane& side, Vec3<Float> origin, Vec3<Float> direction) {
    const Float speed = dotForm(side.normal, direction, kParallelSpeed);
    const Float gap = negMulAdd(
        Float(side.normal[0]), origin.x,
        negMulAdd(Float(side.normal[1]), origin.y, negMulAdd(Float(side.normal[2]), origin.z, Float(side.distance))));
    const Float t = gap * repeatableReciprocal(speed);
    UInt face(side.face);
    if constexpr (kShared) {
      const Float along = dotForm(side.separator, mulAdd(direction, t, origin), side.separatorOffset);
      face = select(along > Float(0), UInt(side.other), face);
    }
    const Mask entering = speed < Float(0);
    const Mask later = entering & (t > enter), sooner = andNot(t < leave, entering);
    enter = select(later, t, enter);
    leave = select(sooner, t, leave);
    enterFace = select(later, face, enterFace);
    leaveFace = select(sooner, face, leaveFace);
  }
};

// The first face of a solid that the rays meet: where they enter, or if that is behind them or open, where they leave.
// side: the first of its planes; afterwards of the next solid's.
WAVECREST_INLINE BoxHit intersectSolid(const SolidForm& solid, const SidePlane*& side, Vec3<Float> origin,
                                       Vec3<Float> direction) {
  Inside faces, openings;
  for (uint32_t i = 0; i < solid.single; ++i) faces.take<false>(*side++, origin, direction);
  for (uint32_t i = 0; i < solid.shared; ++i) faces.take<true>(*side++, origin, direction);
  for (uint32_t i = 0; i < solid.open; ++i) openings.take<false>(*side++, origin, direction);
  const Mask entering = (faces.enter > Float(0)) & (faces.enter >= openings.enter);
  const Mask inside = max(faces.enter, openings.enter) <= min(faces.leave, openings.leave);
  const Mask hit = inside & (entering | (faces.leave <= openings.leave));
  return {hit, select(entering, faces.enter, faces.leave), select(entering, faces.enterFace, faces.leaveFace)};
}

WAVECREST_INLINE Float intersectSphere(const SphereForm& sphere, Vec3<Float> origin, Vec3<Float> direction) {
  const Vec3<Float> center{sphere.center[0], sphere.center[1], sphere.center[2]};
  return intersectSpheres(center, Float(sphere.radius), origin, direction);
}

// ---- all of a scene ------------------------------------------------------------------------------------------------

// Calls taker.take(met, t, primitive) for each box, solid and sphere, and taker.take(hit, primitive) with the PlaneHit
// of each plane: where met, the rays' lines meet it at t. |direction| <= 1.
template <class Taker>
WAVECREST_INLINE void intersectAll(const SmallSceneView& scene, Vec3<Float> origin, Vec3<Float> direction,
                                   Taker& taker) {
  uint32_t box = 0;
  for (; box < scene.closedBoxCount; ++box) {
    const BoxHit hit = intersectBox<false>(scene.boxes[box], origin, direction);
    taker.take(hit.hit, hit.t, hit.primitive);
  }
  for (const uint32_t end = box + scene.openBoxCount; box < end; ++box) {
    const BoxHit hit = intersectBox<true>(scene.boxes[box], origin, direction);
    taker.take(hit.hit, hit.t, hit.primitive);
  }
  const SidePlane* side = scene.sides;
  for (uint32_t i = 0; i < scene.solidCount; ++i) {
    const BoxHit hit = intersectSolid(scene.solids[i], side, origin, direction);
    taker.take(hit.hit, hit.t, hit.primitive);
  }
  uint32_t plane = 0;
  for (; plane < scene.quadCount; ++plane) {
    const PlaneLimits& limits = scene.limits[plane];
    taker.take(intersectPlane<true>(scene.planes[plane], limits, origin, direction), UInt(limits.primitive));
  }
  for (const uint32_t end = plane + scene.triangleCount; plane < end; ++plane) {
    const PlaneLimits& limits = scene.limits[plane];
    taker.take(intersectPlane<false>(scene.planes[plane], limits, origin, direction), UInt(limits.primitive));
  }
  for (uint32_t i = 0; i < scene.sphereCount; ++i) {
    taker.take(allLanes(), intersectSphere(scene.spheres[i], origin, direction), UInt(scene.firstSphere + i));
  }
}

// One ray against all leaves of the scene.
template <bool kAnyHit>
WAVECREST_INLINE void visitLeaves(const SmallSceneView& scene, BvhRay<kAnyHit>& ray) {
  for (uint32_t i = 0; i < scene.faceLeafCount; ++i) ray.visit(scene.faceLeaves[i]);
  for (uint32_t i = 0; i < scene.sphereLeafCount; ++i) ray.visit(scene.sphereLeaves[i]);
}

WAVECREST_SIMD_END
