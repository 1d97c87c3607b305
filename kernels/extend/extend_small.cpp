// extend, small scenes: the closest hit of each ray by testing every primitive.
//
// in: Rays [n]. out: Hits [n], in ray order. Rays are in float under every precision policy. The order of the tests
// decides ties, boxes first, so the result does not depend on the width of a block.
#include "kernels/extend/face_coordinates.h"
#include "kernels/extend/small_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The closest hits of one block: the taker of intersectAll. A plane is missed only by rays that pass outside of its
// edges beyond doubt, so no hit is lost. The nearest hit may be one too many, which its limit tells. What lies behind a
// hit without doubt does not matter.
struct Closest {
  Float t;
  UInt primitive;
  Float limit;  // PlaneHit's, or 0 where there is no doubt

  WAVECREST_INLINE void take(Mask hit, Float distance, UInt index) { take(hit, distance, index, Float(0)); }
  WAVECREST_INLINE void take(const PlaneHit& hit, UInt index) { take(hit.edge <= hit.limit, hit.t, index, hit.limit); }

 private:
  WAVECREST_INLINE void take(Mask hit, Float distance, UInt index, Float bound) {
    const Mask closer = hit & (distance > Float(0)) & (distance < t);
    t = select(closer, distance, t);
    primitive = select(closer, index, primitive);
    limit = select(closer, bound, limit);
  }
};

struct Found {
  HitCoordinates<Float> at;  // in the primitive, kept off its edges; for a sphere u is the distance t
  Mask doubtful;             // an edge is nearer than rounding may move the hit
};

// Computed once for the closest hit, from the point, instead of being kept for each candidate.
WAVECREST_INLINE Found coordinatesOf(const SmallSceneView& scene, const Closest& best, Vec3<Float> origin,
                                     Vec3<Float> direction) {
  // A scene of spheres alone has no faces to read coordinates from.
  if (scene.firstSphere == 0) return {{best.t, Float(0)}, noLanes()};
  const Vec3<Float> point = mulAdd(direction, best.t, origin);
  // Lanes that met no face read the maps of the last face; nothing uses the result.
  const RecordLanes<FaceCoordinates> face(scene.coordinates, min(best.primitive, UInt(scene.firstSphere - 1)));
  const auto along = [&](const FourColumns<Float>& row) WAVECREST_LAMBDA {
    return mulAdd(row.a, point.x, mulAdd(row.b, point.y, mulAdd(row.c, point.z, row.d)));
  };
  const Float u = along(face.four(scene.coordinates->uAxis[0])), v = along(face.four(scene.coordinates->vAxis[0]));
  const Mask isFace = best.primitive < UInt(scene.firstSphere);
  // PlaneHit's edge once more: twice the distance from the middle, or 1 less the least weight of a corner.
  Float edge = max(abs(u + u - Float(1)), abs(v + v - Float(1)));
  auto at = insideQuad(u, v);
  if (scene.firstTriangle != scene.firstSphere) {
    const Mask triangle = !(best.primitive < UInt(scene.firstTriangle));
    edge = select(triangle, max(Float(1) - min(u, v), u + v), edge);
    at = insideEdges(u, v, triangle);
  }
  // PlaneHit::edge is inside up to 1, with an error of up to limit - 1. Boxes and solids have a limit of 0 and are
  // never in doubt.
  const Mask doubtful = isFace & (edge + best.limit > Float(2));
  if (scene.sphereCount == 0) return {at, doubtful};
  return {{select(isFace, at.u, best.t), zeroUnless(isFace, at.v)}, doubtful};
}

// Finds the hits of the doubtful rays of block i anew, one by one.
template <class S>
WAVECREST_NOINLINE void decideByLeaves(const SmallSceneView& scene, const Rays<S>& rays, Mask doubtful, size_t i,
                                       Hits& hits) {
  HWY_ALIGN uint32_t places[kLanes], id[kLanes] = {};
  HWY_ALIGN float second[kLanes] = {}, third[kLanes] = {};
  // Trace the rays against all leaves, packed to the front.
  const size_t count = countTrue(doubtful);
  store(compress(laneIndex(), doubtful), places);
  for (size_t k = 0; k < count; ++k) {
    const size_t at = i + places[k];
    const auto of = [at](const Column<S>& column) { return static_cast<float>(column[at]); };
    BvhRay<false> ray;
    ray.begin(at, of(rays.originX), of(rays.originY), of(rays.originZ), of(rays.directionX), of(rays.directionY),
              of(rays.directionZ), kFarthest);
    visitLeaves(scene, ray);
    id[k] = ray.hit.id;
    second[k] = ray.hit.second;
    third[k] = ray.hit.third;
  }
  // Make coordinates of the weights, all rays at once, and put the hits in their places.
  const HitCoordinates<Float> found = coordinatesInFace(load(id), load(second), load(third));
  storeUnaligned(found.u, second);
  storeUnaligned(found.v, third);
  for (size_t k = 0; k < count; ++k) {
    const size_t at = i + places[k];
    hits.primitive[at] = id[k] == kMiss ? kMiss : id[k] & kFacePrimitiveMask;
    hits.u[at] = second[k];
    hits.v[at] = third[k];
  }
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
    // Find the closest hit of each ray and its coordinates. Rays whose hit is in doubt are decided anew.
    Closest best{Float(3.0e38f), UInt(kMiss), Float(0)};
    intersectAll(scene, origin, direction, best);
    const Found found = coordinatesOf(scene, best, origin, direction);
    store(found.at.u, wave.hits.u, i);
    store(found.at.v, wave.hits.v, i);
    store(best.primitive, wave.hits.primitive, i);
    if (any(found.doubtful)) decideByLeaves(scene, rays, found.doubtful & firstLanes(count - i), i, wave.hits);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(extendSmall)
