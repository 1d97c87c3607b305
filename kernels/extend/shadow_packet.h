// Shadow rays in the hierarchy of bvh.h, a block of them together for as long as they visit the same entries.
//
// The rays of a block start at neighbouring points, or end at the same lights. A packet tests a box for all its rays at
// once, and takes those that meet it along. Where these are few, each costs less alone: the entry goes to a list of the
// ray, from which a BvhRay begins when all packets of the batch are through. A ray that is blocked leaves its packet.
#pragma once

#include <algorithm>

#include "kernels/extend/bvh_ray.h"

WAVECREST_SIMD_BEGIN

// The entries that the rays of a batch have to visit alone.
struct LoneEntries {
  static constexpr size_t kRays = 1024;
  uint32_t count[kRays];
  uint32_t entry[kRays][kMostLoneEntries];

  WAVECREST_INLINE void clear(size_t rays) { std::fill_n(count, rays, 0u); }
  // Gives an entry to some rays, lane k being ray first + k. False, and nothing is done, if one of them has no room.
  WAVECREST_INLINE bool add(size_t first, Mask rays, uint32_t reference) {
    HWY_ALIGN uint32_t lanes[kLanes];
    store(compress(laneIndex(static_cast<uint32_t>(first)), rays), lanes);
    const size_t size = countTrue(rays);
    for (size_t k = 0; k < size; ++k) {
      if (count[lanes[k]] == kMostLoneEntries) return false;
    }
    for (size_t k = 0; k < size; ++k) entry[lanes[k]][count[lanes[k]]++] = reference;
    return true;
  }
};

struct ShadowPacket : BvhPacket {
  // So few rays are better off alone. Measured (kernels/MEASUREMENTS.md): of sixteen, eight to twelve are about as
  // good; of eight, three or six are slower.
  static constexpr size_t kFew = kLanes * 5 / 8;

  LoneEntries* alone;
  uint32_t blocker;          // the last leaf that blocked a ray, or kBvhEnd
  Mask open;                 // rays that nothing blocks yet
  Mask entering[kBvhStack];  // the rays that visit the entry at this place of the stack

  // first: index of the first ray in the batch. Begins at `leaf` and goes on at the root.
  WAVECREST_INLINE void begin(size_t first, Mask rays, Vec3<Float> o, Vec3<Float> d, LoneEntries& entries,
                              uint32_t leaf) {
    BvhPacket::begin(first, o, d);
    end = kShadowEnd;
    t = Float(end);
    alone = &entries;
    blocker = kBvhEnd;
    open = rays;
    entering[waiting] = rays;
    if (leaf == kBvhEnd) return;
    stack[waiting++] = at;
    entering[waiting] = rays;
    at = leaf;
  }

  WAVECREST_INLINE void visit(const BvhNode& node) {
    const Mask active = entering[waiting] & open;
    if (none(active)) return;
    forEachChild<false>(node, [&](uint32_t child, Mask met) HWY_ATTR {
      const Mask rays = met & active;
      const size_t count = countTrue(rays);
      if (count <= kFew && (count == 0 || alone->add(index, rays, child))) return;
      stack[waiting] = child;
      entering[waiting++] = rays;
    });
  }
  WAVECREST_INLINE void visit(const FaceLeaf& faces) {
    forEachFace(faces, [&](Mask met, const FaceHit<Float>& hit, UInt) HWY_ATTR { block(met & (hit.t <= t)); });
    stopIfBlocked();
  }
  WAVECREST_INLINE void visit(const SphereLeaf& spheres) {
    forEachSphere(spheres, [&](Float distance, UInt) HWY_ATTR { block((distance > Float(0)) & (distance <= t)); });
    stopIfBlocked();
  }

 private:
  WAVECREST_INLINE void block(Mask rays) {
    if (none(rays & open)) return;
    blocker = at;
    open = andNot(open, rays);
  }
  WAVECREST_INLINE void stopIfBlocked() {
    if (none(open)) waiting = 1;
  }
};

WAVECREST_SIMD_END
