// What extend does in a hierarchy of either kind, of one level (extend_bvh.cpp) or two (extend_instances.cpp): rays to
// walkers, and what walkers found to hits.
#pragma once

#include "kernels/extend/bvh_ray.h"
#include "kernels/extend/face_coordinates.h"
#include "kernels/extend/prefetch_hits.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

template <class S>
WAVECREST_INLINE void prefetchHit(const SceneView<S>& scene, uint32_t id) {
  if (id != kMiss) prefetchPrimitive(scene, id & kFacePrimitiveMask);
}

// From weights of corners to coordinates of the primitive, kept off its edges.
template <class S>
WAVECREST_INLINE void finish(const SceneView<S>& scene, Hits& hits, size_t i) {
  const UInt id = load(hits.primitive, i);
  const HitCoordinates<Float> at = coordinatesInFace(id, load(hits.u, i), load(hits.v, i));
  store(at.u, hits.u, i);
  store(at.v, hits.v, i);
  store(select(id == UInt(kMiss), id, id & UInt(kFacePrimitiveMask)), hits.primitive, i);
  if (scene.attributes != nullptr) prefetchAttributes(scene, hits.primitive + i, kLanes);
}

// Rays in packets of a block; those behind the last ray repeat the first of their packet.
template <class Packet, class S>
WAVECREST_NOINLINE void walkTogether(const SceneView<S>& scene, const Rays<S>& rays, Hits& hits) {
  size_t next = 0;
  walkBvh<Packet>(
      *scene.bvh,
      [&](Packet& packet) HWY_ATTR {
        if (next >= rays.size) return false;
        const Mask present = firstLanes(rays.size - next);
        const auto lanes = [&](const Column<S>& column) HWY_ATTR {
          return select(present, to<Float>(load(column, next)), Float(static_cast<float>(column[next])));
        };
        packet.begin(next, {lanes(rays.originX), lanes(rays.originY), lanes(rays.originZ)},
                     {lanes(rays.directionX), lanes(rays.directionY), lanes(rays.directionZ)});
        next += kLanes;
        return true;
      },
      [&](const Packet& packet) HWY_ATTR {
        store(packet.id, hits.primitive, packet.index);
        store(packet.second, hits.u, packet.index);
        store(packet.third, hits.v, packet.index);
        if constexpr (EntersInstances<Packet>) store(packet.instance, hits.instance, packet.index);
        for (size_t k = 0; k < kLanes; ++k) prefetchHit(scene, hits.primitive[packet.index + k]);
      });
}

template <class Ray, class S>
WAVECREST_NOINLINE void walkAlone(const SceneView<S>& scene, const Rays<S>& rays, Hits& hits) {
  size_t next = 0;
  walkBvh<Ray>(
      *scene.bvh,
      [&](Ray& ray) HWY_ATTR {
        if (next >= rays.size) return false;
        const auto of = [&](const Column<S>& column) { return static_cast<float>(column[next]); };
        ray.begin(next, of(rays.originX), of(rays.originY), of(rays.originZ), of(rays.directionX), of(rays.directionY),
                  of(rays.directionZ), kFarthest);
        ++next;
        return true;
      },
      [&](const Ray& ray) HWY_ATTR {
        hits.primitive[ray.index] = ray.hit.id;
        hits.u[ray.index] = ray.hit.second;
        hits.v[ray.index] = ray.hit.third;
        if constexpr (EntersInstances<Ray>) hits.instance[ray.index] = ray.instance;
        prefetchHit(scene, ray.hit.id);
      });
}

// Ray and Packet: the walkers of bvh_ray.h, or those that know instances.
template <class Ray, class Packet, class S>
WAVECREST_INLINE void extendThrough(const StageContext<S>& context, Wave<S>& wave) {
  const auto& scene = *context.scene;
  const size_t count = wave.rays.size;
  context.counters->raysClosest += count;
  wave.hits.size = 0;
  wave.hits.claim(count);
  // Camera rays of neighbouring lanes are coherent, except where each lane chooses a pixel of its own.
  if (context.walk == Walk::camera && context.depth == 1 && context.lanes.pixel == nullptr) {
    walkTogether<Packet>(scene, wave.rays, wave.hits);
  } else {
    walkAlone<Ray>(scene, wave.rays, wave.hits);
  }
  for (size_t i = 0; i < count; i += kLanes) finish(scene, wave.hits, i);
}

WAVECREST_SIMD_END
