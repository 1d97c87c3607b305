#include "kernels/extend/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/extend/bvh_branches.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

constexpr double kGrid = 255;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// How far boxes are widened. A ray's distances to the planes of a box are (corner - origin) / direction + step * (scale
// / direction): six roundings, each of which moves the plane by at most a unit roundoff of the distance between origin
// and box. The corners of triangles are as uncertain, relative to the origin and laid along the ray.
float marginFor(const Box& all, const double (&eye)[3]) {
  return static_cast<float>(16 * kUnitRoundoff * rayReach(all, eye));
}

struct Counts {
  size_t nodes = 0, leaves = 0;
};
void countBranches(const Branch& branch, Counts& counts) {
  ++(branch.leaf ? counts.leaves : counts.nodes);
  if (branch.leaf) return;
  for (uint32_t i = 0; i < branch.count; ++i) countBranches(*asNode(branch).child[i], counts);
}
// The most references that a walk from the branch leaves on its stack.
size_t stackNeed(const Branch& branch) {
  if (branch.leaf) return 1;
  size_t deepest = 0;
  for (uint32_t i = 0; i < branch.count; ++i) deepest = std::max(deepest, stackNeed(*asNode(branch).child[i]));
  return branch.count - 1 + deepest;
}

// Writes the boxes of a node's children, each widened by the margin on every side.
void layBoxes(const Box* boxes, size_t count, double margin, BvhNode& node) {
  const Box all = unionOf(boxes, count);
  for (size_t axis = 0; axis < 3; ++axis) {
    const double lowest = std::max(all.low[axis] - margin, double{std::numeric_limits<float>::lowest()});
    const double corner = node.corner[axis] = std::nextafter(static_cast<float>(lowest), -kInfinity);
    const double extent = std::max(all.high[axis] + margin - corner, double{std::numeric_limits<float>::min()} * kGrid);
    const double scale = std::exp2(std::ceil(std::log2(extent / kGrid)));
    node.scale[axis] = static_cast<float>(scale);
    for (size_t i = 0; i < kBvhWidth; ++i) {
      const bool present = i < count;
      const double low = present ? std::floor((boxes[i].low[axis] - margin - corner) / scale) : kGrid;
      const double high = present ? std::ceil((boxes[i].high[axis] + margin - corner) / scale) : 0;
      node.bounds[axis][i] = static_cast<uint8_t>(std::clamp(low, 0.0, kGrid));
      node.bounds[3 + axis][i] = static_cast<uint8_t>(std::clamp(high, 0.0, kGrid));
    }
  }
}

// Where nodes and leaves go: all nodes before all leaves, and the children of a node side by side.
class Layout {
 public:
  Layout(std::byte* arena, size_t nodes, double margin)
      : arena_(arena), nextLeaf_(nodes * sizeof(BvhNode)), margin_(margin) {}

  // The reference of a hierarchy. makeLeaf(branch): its leaf.
  template <class MakeLeaf>
  uint32_t add(const Branch& root, BvhEntry leaf, const MakeLeaf& makeLeaf) {
    using Leaf = decltype(makeLeaf(asLeaf(root)));
    const uint32_t reference = reserve<Leaf>(root, leaf);
    lay<Leaf>(root, reference, leaf, makeLeaf);
    return reference;
  }
  // A node over two hierarchies.
  uint32_t join(uint32_t first, const Box& firstBox, uint32_t second, const Box& secondBox) {
    const uint32_t reference = takeNode();
    auto& node = *new (place(reference)) BvhNode;
    const Box boxes[] = {firstBox, secondBox};
    layBoxes(boxes, 2, margin_, node);
    std::fill_n(node.children, kBvhWidth, kBvhEnd);
    node.children[0] = first;
    node.children[1] = second;
    return reference;
  }

 private:
  uint32_t takeNode() {
    const size_t at = nextNode_;
    nextNode_ += sizeof(BvhNode);
    return makeReference(BvhEntry::node, at);
  }
  template <class Leaf>
  uint32_t reserve(const Branch& branch, BvhEntry leaf) {
    if (!branch.leaf) return takeNode();
    const size_t at = nextLeaf_;
    nextLeaf_ += sizeof(Leaf);
    return makeReference(leaf, at);
  }
  template <class Leaf, class MakeLeaf>
  void lay(const Branch& branch, uint32_t reference, BvhEntry leaf, const MakeLeaf& makeLeaf) {
    if (branch.leaf) {
      new (place(reference)) Leaf(makeLeaf(asLeaf(branch)));
      return;
    }
    const BranchNode& from = asNode(branch);
    auto& node = *new (place(reference)) BvhNode;
    layBoxes(from.box, from.count, margin_, node);
    for (size_t i = 0; i < kBvhWidth; ++i) {
      node.children[i] = i < from.count ? reserve<Leaf>(*from.child[i], leaf) : kBvhEnd;
    }
    for (size_t i = 0; i < from.count; ++i) lay<Leaf>(*from.child[i], node.children[i], leaf, makeLeaf);
  }
  void* place(uint32_t reference) const { return arena_ + size_t{reference & kBvhOffsetMask} * kBvhUnit; }

  std::byte* arena_;
  size_t nextNode_ = 0, nextLeaf_;
  double margin_;
};

}  // namespace

Bvh::Bvh(const PrimitiveRecord<double>* primitives, size_t count, const double (&eye)[3]) {
  const LeafMaker leaves(primitives, count);
  std::optional<BranchTree> faceTree, sphereTree;
  std::vector<Box> bounds;
  Counts faceCounts, sphereCounts;
  size_t stack = 0;
  const auto grow = [&](const Pieces& pieces, std::optional<BranchTree>& tree, Counts& counts) {
    if (pieces.empty()) return;
    tree.emplace(pieces.boxes);
    countBranches(tree->root(), counts);
    stack = std::max(stack, stackNeed(tree->root()));
    bounds.push_back(pieces.bounds());
  };
  grow(leaves.faces(), faceTree, faceCounts);
  grow(leaves.spheres(), sphereTree, sphereCounts);
  // One reference for the other hierarchy, one for the end, and a whole node written at once.
  if (stack + 2 + kBvhWidth > kBvhStack) throw std::runtime_error("the hierarchy is too deep");

  const size_t nodes = faceCounts.nodes + sphereCounts.nodes + 1;
  const size_t used =
      nodes * sizeof(BvhNode) + faceCounts.leaves * sizeof(FaceLeaf) + sphereCounts.leaves * sizeof(SphereLeaf);
  if (used / kBvhUnit > kBvhOffsetMask) throw std::runtime_error("the hierarchy is too large");
  arena_ = MemoryBlock(used, sizeof(BvhNode));

  Layout layout(arena_.get(), nodes, marginFor(unionOf(bounds.data(), bounds.size()), eye));
  view_.arena = arena_.get();
  if (faceTree) {
    view_.root = layout.add(faceTree->root(), BvhEntry::faces,
                            [&](const BranchLeaf& leaf) { return leaves.faceLeaf(leaf.item, leaf.count); });
  }
  if (sphereTree) {
    const uint32_t root = layout.add(sphereTree->root(), BvhEntry::spheres,
                                     [&](const BranchLeaf& leaf) { return leaves.sphereLeaf(leaf.item, leaf.count); });
    view_.root = faceTree ? layout.join(view_.root, bounds.front(), root, bounds.back()) : root;
  }
}

}  // namespace wavecrest
