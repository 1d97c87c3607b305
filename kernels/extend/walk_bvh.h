// Rays through the hierarchy of bvh.h, many at a time.
//
// A ray of its own spends its time waiting for memory and for branches that cannot be foreseen. Here some sixty
// walkers, each a ray or a packet of rays, are under way at once: one takes a step, prefetches what its next one reads,
// and makes room for the others. A step has no branch but the end of its loop: walkers are kept in one list for each
// kind of entry that they visit, and a node's children go to the walker's stack sorted in a register.
//
// A walker has `at`, the entry that it visits; `stack`, the entries that it has still to visit, of which `waiting`
// are in use; `index`; and visit(BvhNode), visit(FaceLeaf) and visit(SphereLeaf). It begins at the root, unless
// begin(walker) puts it elsewhere. A walker that knows instances (placed_rays.h) has enter(InstanceLeaf), which says
// whether it goes on at the root of the group, and leave().
#pragma once

#include <cstring>
#include <type_traits>

#include "kernels/extend/bvh_lanes.h"

WAVECREST_SIMD_BEGIN

// Distances along a ray are found by a division that must not give NaN: directions of zero count as tiny.
constexpr float kLeastDirection = 1e-18f;

WAVECREST_INLINE void prefetchEntry(const BvhView& bvh, uint32_t reference) {
  const std::byte* const there = bvh.address(reference);
  __builtin_prefetch(there);
  __builtin_prefetch(there + 64);
  __builtin_prefetch(there + 128);
}

template <class Walker>
concept EntersInstances = requires(Walker& walker, const InstanceLeaf& leaf) {
  walker.enter(leaf);
  walker.leave();
};

// Call it from a function of its own that is not inlined: next to other loops g++ keeps what a step needs in memory.
//
// Walks for as long as begin(walker) finds something to do. end(walker): takes what was found. Walker::kUnderWay: at
// most 255.
template <class Walker, class Begin, class End>
WAVECREST_INLINE void walkBvh(const BvhView& bvh, const Begin& begin, const End& end) {
  constexpr size_t kUnderWay = Walker::kUnderWay;
  Walker walkers[kUnderWay];
  // The walkers at each kind of entry; BvhEntry::end: those that are done.
  constexpr size_t kEntries = 4;
  uint8_t lists[kEntries][kUnderWay], current[kUnderWay];
  size_t sizes[kEntries] = {};
  // Puts a walker on the list of its next entry's kind.
  const auto stand = [&](uint8_t i, uint32_t reference) WAVECREST_LAMBDA {
    walkers[i].at = reference;
    const uint32_t entry = reference >> kBvhEntryShift;
    lists[entry][sizes[entry]++] = i;
  };
  // Takes the next waiting entry off the walker's stack and fetches it ahead of the visit.
  const auto goOn = [&](uint8_t i) WAVECREST_LAMBDA {
    const uint32_t reference = walkers[i].stack[--walkers[i].waiting];
    prefetchEntry(bvh, reference);
    stand(i, reference);
  };
  // Gives a walker its next ray, if there is one.
  const auto enter = [&](uint8_t i) WAVECREST_LAMBDA {
    Walker& walker = walkers[i];
    walker.stack[0] = kBvhEnd;
    walker.waiting = 1;
    walker.at = bvh.root;
    if (!begin(walker)) return;
    stand(i, walker.at);
  };
  // In or out of an instance.
  [[maybe_unused]] const auto pass = [&](uint8_t i) WAVECREST_LAMBDA {
    if constexpr (EntersInstances<Walker>) {
      Walker& walker = walkers[i];
      if (walker.at == kBvhLeave) {
        walker.leave();
      } else if (const InstanceLeaf& leaf = bvh.at<InstanceLeaf>(walker.at); walker.enter(leaf)) {
        walker.stack[walker.waiting++] = kBvhLeave;
        return stand(i, leaf.root);
      }
      goOn(i);
    }
  };
  // Moves the list aside, so that walkers may join it again.
  const auto take = [&](BvhEntry entry) WAVECREST_LAMBDA {
    const auto which = static_cast<size_t>(entry);
    std::memcpy(current, lists[which], kUnderWay);
    const size_t size = sizes[which];
    sizes[which] = 0;
    return size;
  };
  // All walkers that visit an entry of one kind: the same code for each, one after the other.
  const auto visitAll = [&]<class Record>(BvhEntry entry, std::type_identity<Record>) WAVECREST_LAMBDA {
    for (size_t k = 0, size = take(entry); k < size; ++k) {
      Walker& walker = walkers[current[k]];
      walker.visit(bvh.at<Record>(walker.at));
      goOn(current[k]);
    }
  };

  // Every walker begins with a ray; each turn visits all nodes, then all leaves, and replaces the rays that are done.
  for (size_t i = 0; i < kUnderWay; ++i) enter(static_cast<uint8_t>(i));
  while (sizes[0] + sizes[1] + sizes[2] + sizes[3] > 0) {
    visitAll(BvhEntry::node, std::type_identity<BvhNode>());
    visitAll(BvhEntry::faces, std::type_identity<FaceLeaf>());
    visitAll(BvhEntry::spheres, std::type_identity<SphereLeaf>());
    for (size_t k = 0, size = take(BvhEntry::end); k < size; ++k) {
      if constexpr (EntersInstances<Walker>) {
        Walker& walker = walkers[current[k]];
        if (walker.at != kBvhEnd) {
          pass(current[k]);
          continue;
        }
      }
      end(walkers[current[k]]);
      enter(current[k]);
    }
  }
}

WAVECREST_SIMD_END
