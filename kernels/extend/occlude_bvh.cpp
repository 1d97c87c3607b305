// occlude, large scenes: adds the contribution of each shadow ray that nothing in the hierarchy of bvh.h blocks.
//
// in: ShadowRays [n]. out: Radiance grows, or on light walks that splat, Splats; ShadowRays empty.
//
// Rays go in packets while they stay together and alone after that (shadow_packet.h), and begin where others to the
// same end were blocked (last_blockers.h). None of this changes what they find, and contributions are added in their
// order.
#include <algorithm>

#include "kernels/extend/last_blockers.h"
#include "kernels/extend/occlude_lanes.h"
#include "kernels/extend/shadow_packet.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr bool kPackets = kLanes >= 8;  // blocks of fewer lanes gain nothing by them
constexpr size_t kTrialRays = 256;      // of the first batch

// Some rays of a wave that are walked in packets, and whether nothing blocks them, as 1 or 0.
struct Batch {
  size_t first, count;
  LoneEntries alone;
  HWY_ALIGN float visible[LoneEntries::kRays];
};

// Walks the batch in packets. Entries that rays have to visit alone go to batch.alone.
[[maybe_unused]] WAVECREST_NOINLINE void walkTogether(const BvhView& bvh, const ShadowSegments& rays,
                                                      LastBlockers& blockers, Batch& batch) {
  // The end of a packet's first ray stands for the ends of all its rays.
  const auto blockerOf = [&](size_t i) HWY_ATTR -> uint32_t& {
    return blockers.towards(rays.originX[i] + rays.directionX[i], rays.originY[i] + rays.directionY[i],
                            rays.originZ[i] + rays.directionZ[i]);
  };
  size_t next = 0;
  batch.alone.clear(batch.count);
  walkBvh<ShadowPacket>(
      bvh,
      [&](ShadowPacket& packet) HWY_ATTR {
        if (next >= batch.count) return false;
        // Those behind the last ray repeat the first of their packet.
        const Mask present = firstLanes(batch.count - next);
        const size_t i = batch.first + next;
        const auto lanes = [&](const float* column)
                               HWY_ATTR { return select(present, load(column + i), Float(column[i])); };
        packet.begin(next, present, {lanes(rays.originX), lanes(rays.originY), lanes(rays.originZ)},
                     {lanes(rays.directionX), lanes(rays.directionY), lanes(rays.directionZ)}, batch.alone,
                     blockerOf(i));
        next += kLanes;
        return true;
      },
      [&](const ShadowPacket& packet) HWY_ATTR {
        store(select(packet.open, Float(1), Float(0)), batch.visible + packet.index);
        if (packet.blocker != kBvhEnd) blockerOf(batch.first + packet.index) = packet.blocker;
      });
}

// Finishes the rays that packets have left, each from the entries that were left to it.
[[maybe_unused]] WAVECREST_NOINLINE void finishAlone(const BvhView& bvh, const ShadowSegments& rays, Batch& batch) {
  size_t next = 0;
  walkBvh<BvhRay<true>>(
      bvh,
      [&](BvhRay<true>& ray) HWY_ATTR {
        // Blocked rays are done, and so are rays without entries of their own.
        while (next < batch.count && (batch.visible[next] == 0 || batch.alone.count[next] == 0)) ++next;
        if (next >= batch.count) return false;
        beginShadowRay(ray, next, rays, batch.first + next);
        // The walk begins at the last entry instead of the root. The others wait on the stack, above the end.
        const uint32_t* const entries = batch.alone.entry[next];
        const uint32_t last = batch.alone.count[next] - 1;
        std::copy_n(entries, last, ray.stack + 1);
        ray.waiting = 1 + last;
        ray.at = entries[last];
        prefetchEntry(bvh, ray.at);
        ++next;
        return true;
      },
      [&](const BvhRay<true>& ray) HWY_ATTR {
        if (ray.hit.id != kMiss) batch.visible[ray.index] = 0;
      });
}

// Whether packets of rays like those of the batch are worth it: many of them were blocked in their packet, or hardly
// any is left to finish alone. kernels/MEASUREMENTS.md has the shares of some scenes. Call between walkTogether and
// finishAlone.
[[maybe_unused]] bool goesTogether(const Batch& batch) {
  size_t blocked = 0, left = 0;
  for (size_t i = 0; i < batch.count; ++i) {
    const bool open = batch.visible[i] != 0;
    blocked += open ? 0 : 1;
    left += open && batch.alone.count[i] != 0 ? 1 : 0;
  }
  return blocked * 4 >= batch.count || left * 8 <= batch.count;
}

// Writes `visible` of each ray. A first small batch shows whether the others go in packets too.
WAVECREST_INLINE void walkAll(const BvhView& bvh, const ShadowSegments& rays, float* visible) {
  size_t first = 0;
  if constexpr (kPackets) {
    LastBlockers blockers(bvh);
    Batch batch;
    for (bool together = true; together && first < rays.size; first += batch.count) {
      batch.first = first;
      batch.count = std::min(rays.size - first, first == 0 ? kTrialRays : LoneEntries::kRays);
      walkTogether(bvh, rays, blockers, batch);
      together = goesTogether(batch);
      finishAlone(bvh, rays, batch);
      std::copy_n(batch.visible, batch.count, visible + first);
    }
  }
  walkShadowRaysAlone<BvhRay<true>>(bvh, rays, first, visible);
}

}  // namespace

template <class P>
void occludeBvh(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  occludeThrough(context, wave, [](const BvhView& bvh, const ShadowSegments& rays, float* visible) HWY_ATTR {
    walkAll(bvh, rays, visible);
  });
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(occludeBvh)
