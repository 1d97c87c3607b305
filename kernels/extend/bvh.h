// The intersector of large scenes: a bounding volume hierarchy of eight-wide nodes whose boxes are kept in bytes.
//
// A node is two cache lines: the boxes of its children on a grid of 255 steps over their union (Ylitie, Karras, Laine,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017), and a reference to each child.
// Leaves hold up to four triangles, or spheres, in columns. A mesh of a million triangles has 10 MB of nodes and 45 MB
// of leaves.
//
// Watertightness: boxes are widened by a bound on the rounding of their test (bvh.cpp). Triangles are not: those that
// share an edge agree on which of its sides a ray passes (bvh_lanes.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/columns/memory_block.h"
#include "kernels/extend/leaves.h"
#include "kernels/scene_view.h"

namespace wavecrest {

constexpr size_t kBvhWidth = 8;  // children of a node

// A reference: what it leads to in the upper two bits, and the distance from the arena's begin in units of 32 bytes.
enum class BvhEntry : uint32_t { node, faces, spheres, end };
constexpr uint32_t kBvhUnit = 32, kBvhEntryShift = 30, kBvhOffsetMask = (1u << kBvhEntryShift) - 1;
constexpr BvhEntry entryOf(uint32_t reference) { return static_cast<BvhEntry>(reference >> kBvhEntryShift); }
constexpr uint32_t makeReference(BvhEntry entry, size_t bytes) {
  return static_cast<uint32_t>(entry) << kBvhEntryShift | static_cast<uint32_t>(bytes / kBvhUnit);
}
constexpr uint32_t kBvhEnd = makeReference(BvhEntry::end, 0);

// Planes of child i along an axis: corner + scale * bounds[axis or 3 + axis][i], low ones before high ones. Scales are
// powers of two. Absent children have low above high.
struct alignas(128) BvhNode {
  uint32_t children[kBvhWidth];
  float corner[3], scale[3];
  uint8_t bounds[6][kBvhWidth];
};
static_assert(sizeof(BvhNode) == 128);

// Room for the references that a ray has still to visit.
constexpr size_t kBvhStack = 256;

struct BvhView {
  const std::byte* arena = nullptr;
  uint32_t root = kBvhEnd;

  const std::byte* address(uint32_t reference) const { return arena + size_t{reference & kBvhOffsetMask} * kBvhUnit; }
  template <class Record>
  const Record& at(uint32_t reference) const {
    return *reinterpret_cast<const Record*>(address(reference));
  }
};

class Bvh {
 public:
  // primitives: in SceneView order, in double so that triangles which share a corner agree on its float. eye: another
  // point that rays start from. Built by as many threads as the calling TBB arena has. Throws std::runtime_error where
  // that fails.
  Bvh(const PrimitiveRecord<double>* primitives, size_t count, const double (&eye)[3]);
  const BvhView& view() const { return view_; }
  size_t bytes() const { return arena_.size(); }

 private:
  MemoryBlock arena_;
  BvhView view_;
};

}  // namespace wavecrest
