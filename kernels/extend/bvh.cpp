#include "kernels/extend/bvh.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>
#include <vector>

#include "kernels/extend/bvh_branches.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

constexpr double kGrid = kBvhGrid;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// How far boxes are widened. A ray's distances to the planes of a box are (corner - origin) / direction + step * (scale
// / direction): six roundings, each of which moves the plane by at most a unit roundoff of the distance between origin
// and box. The corners of triangles are as uncertain, relative to the origin and laid along the ray.
float marginFor(const Box& all, const Box& origins) {
  return static_cast<float>(16 * kUnitRoundoff * rayReach(all, origins));
}

// Writes the boxes of a node's children, each widened by the margin on every side.
void layBoxes(const Box* boxes, size_t count, double margin, BvhNode& node) {
  const Box all = unionOf(boxes, count);
  for (size_t axis = 0; axis < 3; ++axis) {
    // The grid begins one rounding below the lowest widened box.
    const double lowest = std::max(all.low[axis] - margin, double{std::numeric_limits<float>::lowest()});
    const double corner = node.corner[axis] = std::nextafter(static_cast<float>(lowest), -kInfinity);
    // The step is the least power of two whose 255 steps span all boxes, so its product with a byte is exact. The lower
    // limit on the extent keeps the step a normal number.
    const double extent = std::max(all.high[axis] + margin - corner, double{std::numeric_limits<float>::min()} * kGrid);
    const double scale = std::exp2(std::ceil(std::log2(extent / kGrid)));
    node.scale[axis] = static_cast<float>(scale);
    // Boxes are rounded outwards to the grid. Absent children get low above high, which no ray meets.
    for (size_t i = 0; i < kBvhWidth; ++i) {
      const bool present = i < count;
      const double low = present ? std::floor((boxes[i].low[axis] - margin - corner) / scale) : kGrid;
      const double high = present ? std::ceil((boxes[i].high[axis] + margin - corner) / scale) : 0;
      node.bounds[axis][0][i] = node.bounds[axis][2][i] = static_cast<uint8_t>(std::clamp(low, 0.0, kGrid));
      node.bounds[axis][1][i] = static_cast<uint8_t>(std::clamp(high, 0.0, kGrid));
    }
  }
}

// A hierarchy of one kind of leaf before it is laid out. The kind BvhEntry::end stands for instances: each of them is a
// leaf.
struct Part {
  BranchTree tree;
  BvhEntry leaf;
  std::vector<uint32_t> ids;  // of the pieces in the order of the tree's leaves

  Part(Pieces& pieces, BvhEntry kind, const ParallelFor& parallelFor)
      : tree(pieces, parallelFor, kind == BvhEntry::end ? 1 : kLeafSize), leaf(kind) {
    ids.resize(pieces.size());
    forEachRange(parallelFor, ids.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) ids[i] = pieces.begin()[i].id;
    });
    pieces = {};  // the largest thing that building needs
  }
  size_t leafBytes() const {
    if (leaf == BvhEntry::end) return 0;  // instances have places of their own
    return leaf == BvhEntry::faces ? sizeof(FaceLeaf) : sizeof(SphereLeaf);
  }
};

// The hierarchies over the primitives of the world, or of a group, before they are laid out: one for faces, one for
// spheres. In the world one for instances may be added.
struct Level {
  LeafMaker leaves;
  std::vector<Part> parts;

  Level(const PrimitiveSource& primitives, const ParallelFor& parallelFor) : leaves(primitives, parallelFor) {
    if (!leaves.faces().empty()) parts.emplace_back(leaves.faces(), BvhEntry::faces, parallelFor);
    if (!leaves.spheres().empty()) parts.emplace_back(leaves.spheres(), BvhEntry::spheres, parallelFor);
  }
  Box bounds() const {
    std::vector<Box> boxes;
    for (const Part& part : parts) boxes.push_back(part.tree.bounds);
    return unionOf(boxes.data(), boxes.size());
  }
  // Room for all nodes of the parts, and for one that joins the parts. Never none: a reference to an instance at the
  // arena's begin would be kBvhEnd.
  size_t nodes() const {
    size_t count = 1;
    for (const Part& part : parts) count += part.tree.totals.nodes;
    return count;
  }
  size_t leafBytes() const {
    size_t bytes = 0;
    for (const Part& part : parts) bytes += part.tree.totals.leaves * part.leafBytes();
    return bytes;
  }
  // The most references that a walk leaves on its stack, those of the other parts among them.
  size_t stack() const {
    size_t most = 0;
    for (const Part& part : parts) most = std::max(most, part.tree.totals.stack);
    return most + parts.size() - 1;
  }
};

// Where nodes and leaves go: all nodes before all instances before all leaves, and the children of a node side by side.
class Layout {
 public:
  Layout(std::byte* arena, size_t nodes, size_t instances, const ParallelFor& parallelFor)
      : arena_(arena),
        firstInstance_(nodes * sizeof(BvhNode)),
        nextLeaf_(firstInstance_ + instances * sizeof(InstanceLeaf)),
        parallelFor_(parallelFor) {}

  // The reference of all hierarchies of a level.
  uint32_t add(const Level& level, double margin) {
    margin_ = margin;
    leaves_ = &level.leaves;
    // A single hierarchy needs no node above it.
    if (level.parts.size() == 1) return add(level.parts.front());
    uint32_t references[kBvhWidth];
    Box boxes[kBvhWidth];
    for (size_t i = 0; i < level.parts.size(); ++i) {
      references[i] = add(level.parts[i]);
      boxes[i] = level.parts[i].tree.bounds;
    }
    return join(references, boxes, level.parts.size());
  }
  size_t laidNodes() const { return nextNode_ / sizeof(BvhNode); }
  void write(size_t index, const InstanceLeaf& leaf) const { new (place(referenceOf(index))) InstanceLeaf(leaf); }

 private:
  // The reference of a hierarchy.
  uint32_t add(const Part& part) {
    // First every node and leaf gets its place, in one thread, so that the layout does not depend on threads. Then the
    // contents are written in parallel.
    nodes_.clear();
    ends_.clear();
    nodes_.reserve(part.tree.totals.nodes);
    ends_.reserve(part.tree.totals.leaves);
    const uint32_t root = reserve(part, part.tree.root);
    if (!part.tree.root.isLeaf()) lay(part, *part.tree.root.node, root);
    forEachRange(parallelFor_, nodes_.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) writeNode(nodes_[i]);
    });
    forEachRange(parallelFor_, ends_.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) writeLeaf(part, ends_[i]);
    });
    return root;
  }
  // A node over several hierarchies.
  uint32_t join(const uint32_t* references, const Box* boxes, size_t count) {
    const uint32_t reference = takeNode();
    auto& node = *new (place(reference)) BvhNode;
    layBoxes(boxes, count, margin_, node);
    std::fill_n(node.children, kBvhWidth, kBvhEnd);
    std::copy_n(references, count, node.children);
    return reference;
  }

  // A node, or a leaf, that has its place and is not written yet.
  struct PlacedNode {
    const BranchNode* from;
    uint32_t reference;
    uint32_t children[kBvhWidth];  // references
  };
  struct PlacedLeaf {
    Branch from;
    uint32_t reference;
  };

  uint32_t takeNode() {
    const size_t at = nextNode_;
    nextNode_ += sizeof(BvhNode);
    return makeReference(BvhEntry::node, at);
  }
  // Takes the place of a node or leaf and returns the reference to it. Instances have fixed places and are written by
  // write().
  uint32_t reserve(const Part& part, const Branch& branch) {
    if (!branch.isLeaf()) return takeNode();
    if (part.leaf == BvhEntry::end) return referenceOf(part.ids[branch.first]);
    const size_t at = nextLeaf_;
    nextLeaf_ += part.leafBytes();
    const uint32_t reference = makeReference(part.leaf, at);
    ends_.push_back({branch, reference});
    return reference;
  }
  // Takes places for everything below a node, depth first. The children of a node are reserved together before any
  // grandchild, so they lie side by side.
  void lay(const Part& part, const BranchNode& from, uint32_t reference) {
    PlacedNode placed{.from = &from, .reference = reference, .children = {}};
    for (size_t i = 0; i < kBvhWidth; ++i) {
      placed.children[i] = i < from.count ? reserve(part, from.child[i]) : kBvhEnd;
    }
    nodes_.push_back(placed);
    for (size_t i = 0; i < from.count; ++i) {
      if (!from.child[i].isLeaf()) lay(part, *from.child[i].node, placed.children[i]);
    }
  }
  void writeNode(const PlacedNode& placed) const {
    const BranchNode& from = *placed.from;
    auto& node = *new (place(placed.reference)) BvhNode;
    layBoxes(from.box, from.count, margin_, node);
    std::copy_n(placed.children, kBvhWidth, node.children);
  }
  void writeLeaf(const Part& part, const PlacedLeaf& placed) const {
    const uint32_t* const ids = part.ids.data() + placed.from.first;
    if (part.leaf == BvhEntry::faces) {
      new (place(placed.reference)) FaceLeaf(leaves_->faceLeaf(ids, placed.from.pieces));
    } else {
      new (place(placed.reference)) SphereLeaf(leaves_->sphereLeaf(ids, placed.from.pieces));
    }
  }
  uint32_t referenceOf(size_t instance) const {
    return makeReference(BvhEntry::end, firstInstance_ + instance * sizeof(InstanceLeaf));
  }
  void* place(uint32_t reference) const { return arena_ + size_t{reference & kBvhOffsetMask} * kBvhUnit; }

  std::byte* arena_;
  size_t nextNode_ = 0, firstInstance_, nextLeaf_;
  double margin_ = 0;                  // of the level that is being added, and
  const LeafMaker* leaves_ = nullptr;  // its leaves
  const ParallelFor& parallelFor_;
  std::vector<PlacedNode> nodes_;
  std::vector<PlacedLeaf> ends_;
};

// The boxes of instances, with room for the rounding of rays on their way into the group's space: a few units of the
// distance to the ray's origin, as the transform and its inverse stretch it.
Pieces piecesOf(std::span<const BvhInstance> instances, const Box& origins) {
  std::vector<Box> boxes;
  for (const BvhInstance& instance : instances) boxes.push_back(instance.box);
  Pieces pieces(boxes.size());
  if (boxes.empty()) return pieces;
  const double rounding = 8 * kUnitRoundoff * rayReach(unionOf(boxes.data(), boxes.size()), origins);
  for (size_t i = 0; i < boxes.size(); ++i) {
    Piece& piece = pieces.begin()[i];
    piece = {.low = {}, .id = static_cast<uint32_t>(i), .high = {}, .unused = 0};
    for (size_t axis = 0; axis < 3; ++axis) {
      double stretch = 0;
      for (size_t k = 0; k < 3; ++k) {
        for (size_t j = 0; j < 3; ++j) {
          stretch += std::abs(instances[i].toWorld[axis][k] * instances[i].toObject[k][j]);
        }
      }
      piece.low[axis] = std::nextafter(static_cast<float>(boxes[i].low[axis] - stretch * rounding), -kInfinity);
      piece.high[axis] = std::nextafter(static_cast<float>(boxes[i].high[axis] + stretch * rounding), kInfinity);
    }
  }
  return pieces;
}

// The instance as walkers read it, rounded to float. root: reference of its group's hierarchy.
InstanceLeaf leafOf(const BvhInstance& instance, size_t index, double radius, uint32_t root) {
  InstanceLeaf leaf{.place = {},
                    .toObject = {},
                    .radius = static_cast<float>(radius),
                    .root = root,
                    .index = static_cast<uint32_t>(index)};
  for (size_t i = 0; i < 3; ++i) {
    leaf.place[i] = static_cast<float>(instance.place[i]);
    for (size_t j = 0; j < 3; ++j) leaf.toObject[i][j] = static_cast<float>(instance.toObject[i][j]);
  }
  return leaf;
}

}  // namespace

Bvh::Bvh(const PrimitiveSource& primitives, std::span<const BvhGroup> groups, std::span<const BvhInstance> instances,
         const Box& origins, const ParallelFor& parallelFor) {
  // Build the hierarchies of the world and of each group, and count what they need.
  Level top(primitives, parallelFor);
  Pieces placed = piecesOf(instances, origins);
  if (!placed.empty()) top.parts.emplace_back(placed, BvhEntry::end, parallelFor);
  std::deque<Level> inGroups;
  size_t nodes = top.nodes(), leafBytes = top.leafBytes(), stackInGroups = 0;
  for (const BvhGroup& group : groups) {
    const Level& level = inGroups.emplace_back(group.primitives, parallelFor);
    nodes += level.nodes();
    leafBytes += level.leafBytes();
    // 1: the reference kBvhLeave, which waits below those of the group.
    stackInGroups = std::max(stackInGroups, 1 + level.stack());
  }

  // Check the limits. On its stack a ray also needs one reference for the end, room for a whole node that is written at
  // once, and the entries that a packet leaves to it.
  if (top.stack() + stackInGroups + 1 + kBvhWidth + kMostLoneEntries > kBvhStack) {
    throw std::runtime_error("the hierarchy is too deep");
  }
  const size_t used = nodes * sizeof(BvhNode) + instances.size() * sizeof(InstanceLeaf) + leafBytes;
  if (used / kBvhUnit > kBvhOffsetMask) throw std::runtime_error("the hierarchy is too large");
  arena_ = MemoryBlock(used, sizeof(BvhNode));

  // Lay out the world, then the groups, then the instances, which refer to the roots of their groups.
  Layout layout(arena_.get(), nodes, instances.size(), parallelFor);
  view_.arena = arena_.get();
  view_.root = layout.add(top, marginFor(top.bounds(), origins));
  // Rays in a group start near its origin (PlacedRay::enter).
  std::vector<uint32_t> roots;
  roots.reserve(inGroups.size());
  for (const Level& level : inGroups) roots.push_back(layout.add(level, marginFor(level.bounds(), boxAt({0, 0, 0}))));
  for (size_t i = 0; i < instances.size(); ++i) {
    const uint32_t group = instances[i].group;
    layout.write(i, leafOf(instances[i], i, groups[group].radius, roots[group]));
  }
  nodes_ = layout.laidNodes();
}

}  // namespace wavecrest
