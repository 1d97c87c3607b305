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
#include <span>

#include "kernels/columns/memory_block.h"
#include "kernels/extend/leaves.h"
#include "kernels/scene_view.h"

namespace wavecrest {

constexpr size_t kBvhWidth = 8;  // children of a node
constexpr float kBvhGrid = 255;  // steps of its grid

// A reference: what it leads to in the upper two bits, and the distance from the arena's begin in units of 32 bytes.
enum class BvhEntry : uint32_t { node, faces, spheres, end };
constexpr uint32_t kBvhUnit = 32, kBvhEntryShift = 30, kBvhOffsetMask = (1u << kBvhEntryShift) - 1;
constexpr BvhEntry entryOf(uint32_t reference) { return static_cast<BvhEntry>(reference >> kBvhEntryShift); }
constexpr uint32_t makeReference(BvhEntry entry, size_t bytes) {
  return static_cast<uint32_t>(entry) << kBvhEntryShift | static_cast<uint32_t>(bytes / kBvhUnit);
}
constexpr uint32_t kBvhEnd = makeReference(BvhEntry::end, 0);
// The end of an instance: ray and hit go back to the world. References that end somewhere else are those of
// InstanceLeaf; they are behind all nodes.
constexpr uint32_t kBvhLeave = makeReference(BvhEntry::end, kBvhUnit);

// Planes of child i along an axis: corner + scale * bounds[axis][row][i]. Rows are the low planes, the high ones, and
// the low ones again: so those by which a ray enters and those by which it leaves are two rows one after the other,
// whatever its direction. Scales are powers of two. Absent children have low above high.
constexpr size_t kBvhRows = 3;
struct alignas(128) BvhNode {
  uint32_t children[kBvhWidth];
  float corner[3], scale[3];
  uint8_t bounds[3][kBvhRows][kBvhWidth];
};
static_assert(sizeof(BvhNode) == 128);

// An instance of a group, as rays pass into it: the point p of the world is at toObject (p - place) in the group.
struct alignas(64) InstanceLeaf {
  float place[3], toObject[3][3];
  float radius;          // of a sphere about the group's origin with all of the group in it
  uint32_t root, index;  // of the group; of the instance in SceneView::instances
};
static_assert(sizeof(InstanceLeaf) == 64);

// Room for the references that a ray has still to visit, and how many it may bring along from a packet.
constexpr size_t kMostLoneEntries = 16;
constexpr size_t kBvhStack = 288;

struct BvhView {
  const std::byte* arena = nullptr;
  uint32_t root = kBvhEnd;

  const std::byte* address(uint32_t reference) const { return arena + size_t{reference & kBvhOffsetMask} * kBvhUnit; }
  template <class Record>
  const Record& at(uint32_t reference) const {
    return *reinterpret_cast<const Record*>(address(reference));
  }
};

// A group of primitives in its own space, all of them within a sphere about the origin.
struct BvhGroup {
  PrimitiveSource primitives;
  double radius;
};
// A group in its place: see InstanceRecord. box: of all of it, in the world.
struct BvhInstance {
  uint32_t group;
  double place[3], toWorld[3][3], toObject[3][3];
  Box box;
};

class Bvh {
 public:
  // primitives: at least one. origins: around other points that rays start from. Throws std::runtime_error where the
  // hierarchy would be too large for its references or for a ray's stack.
  Bvh(const PrimitiveSource& primitives, const Box& origins, const ParallelFor& parallelFor)
      : Bvh(primitives, {}, {}, origins, parallelFor) {}
  // Of two levels: over primitives, of which there may be none, and over instances of groups, each of which has some.
  Bvh(const PrimitiveSource& primitives, std::span<const BvhGroup> groups, std::span<const BvhInstance> instances,
      const Box& origins, const ParallelFor& parallelFor);
  // records: in SceneView order.
  Bvh(const PrimitiveRecord<double>* records, size_t count, const Box& origins)
      : Bvh(PrimitiveSource::of(records, count), origins, inTurn) {}
  const BvhView& view() const { return view_; }
  size_t bytes() const { return arena_.size(); }
  size_t nodes() const { return nodes_; }  // none where all primitives are in one leaf

 private:
  MemoryBlock arena_;
  size_t nodes_ = 0;
  BvhView view_;
};

}  // namespace wavecrest
