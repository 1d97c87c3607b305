// extend, small scenes: the closest hit of each ray by testing every primitive.
//
// in: Rays [n]. out: Hits [n], in ray order. Rays are in float under every precision policy. The order of the tests
// decides ties, boxes first, so the result does not depend on the width of a block.
#include "kernels/extend/inset_lanes.h"
#include "kernels/extend/small_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Closest hits of one block.
struct Closest {
  Float t;
  UInt primitive;

  WAVECREST_INLINE void take(Mask hit, Float distance, UInt index) {
    const Mask closer = hit & (distance > Float(0)) & (distance < t);
    t = select(closer, distance, t);
    primitive = select(closer, index, primitive);
  }
};

// In the primitive that was hit, kept off its edges; for a sphere u is the distance t. Computed once for the closest
// hit, from the point, instead of being kept for each candidate.
WAVECREST_INLINE HitCoordinates<Float> coordinatesOf(const SmallSceneView& scene, const Closest& best,
                                                     Vec3<Float> origin, Vec3<Float> direction) {
  if (scene.firstSphere == 0) return {best.t, Float(0)};
  const Vec3<Float> point = mulAdd(direction, best.t, origin);
  const RecordLanes<FaceCoordinates> face(scene.coordinates, min(best.primitive, UInt(scene.firstSphere - 1)));
  const auto along = [&](const FourColumns<Float>& row) WAVECREST_LAMBDA {
    return mulAdd(row.a, point.x, mulAdd(row.b, point.y, mulAdd(row.c, point.z, row.d)));
  };
  const Float u = along(face.four(scene.coordinates->uAxis[0])), v = along(face.four(scene.coordinates->vAxis[0]));
  const auto at =
      scene.triangleCount == 0 ? insideQuad(u, v) : insideEdges(u, v, !(best.primitive < UInt(scene.firstTriangle)));
  if (scene.sphereCount == 0) return at;
  const Mask sphere = !(best.primitive < UInt(scene.firstSphere));
  return {select(sphere, best.t, at.u), zeroUnless(!sphere, at.v)};
}

}  // namespace

template <class P>
void extendSmall(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const SmallSceneView scene = *context.scene->small;
  const auto& rays = wave.rays;
  const size_t count = rays.size;
  context.counters->raysClosest += count;
  wave.hits.size = 0;
  wave.hits.claim(count);
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<Float> origin = to<Float>(loadVec3(rays.originX, rays.originY, rays.originZ, i));
    const Vec3<Float> direction = to<Float>(loadVec3(rays.directionX, rays.directionY, rays.directionZ, i));
    Closest best{Float(3.0e38f), UInt(kMiss)};
    intersectAll(scene, origin, direction, best);
    const HitCoordinates at = coordinatesOf(scene, best, origin, direction);
    store(at.u, wave.hits.u, i);
    store(at.v, wave.hits.v, i);
    store(best.primitive, wave.hits.primitive, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendSmall)
