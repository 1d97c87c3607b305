#include "kernels/extend/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/extend/bvh_branches.h"

namespace wavecrest {
namespace {

constexpr double kGrid = 255;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Corner = std::array<float, 3>;

Corner cornerAt(const PrimitiveRecord<double>& record, double u, double v) {
  Corner corner;
  for (size_t i = 0; i < 3; ++i) corner[i] = static_cast<float>(record.p0[i] + u * record.e1[i] + v * record.e2[i]);
  return corner;
}
std::array<Corner, 3> cornersOf(const PrimitiveRecord<double>& record, FaceKind kind) {
  const Corner origin = cornerAt(record, 0, 0);
  if (kind == FaceKind::lowerHalf) return {origin, cornerAt(record, 1, 0), cornerAt(record, 1, 1)};
  if (kind == FaceKind::upperHalf) return {origin, cornerAt(record, 1, 1), cornerAt(record, 0, 1)};
  return {origin, cornerAt(record, 1, 0), cornerAt(record, 0, 1)};
}

Box boxOf(const std::array<Corner, 3>& corners) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
    box.high[axis] = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
  }
  return box;
}
// Along the longest axis, rounded up.
float sizeOf(const Box& box) {
  float size = 0;
  for (size_t axis = 0; axis < 3; ++axis) size = std::max(size, box.high[axis] - box.low[axis]);
  return std::nextafter(size, kInfinity);
}
Box boxOfSphere(const PrimitiveRecord<double>& record) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::nextafter(static_cast<float>(record.p0[axis] - record.e1[0]), -kInfinity);
    box.high[axis] = std::nextafter(static_cast<float>(record.p0[axis] + record.e1[0]), kInfinity);
  }
  return box;
}

// What leaves hold, one hierarchy for each kind of leaf: ids of slots (bvh.h) and the box of each.
struct Pieces {
  std::vector<uint32_t> ids;
  std::vector<Box> boxes;

  void add(size_t primitive, FaceKind kind, const Box& box) {
    ids.push_back(static_cast<uint32_t>(primitive) | static_cast<uint32_t>(kind) << kFaceKindShift);
    boxes.push_back(box);
  }
};

FaceKind kindOf(uint32_t id) { return static_cast<FaceKind>(id >> kFaceKindShift); }

void growTo(const Box& box, Box& all) {
  for (size_t axis = 0; axis < 3; ++axis) {
    all.low[axis] = std::min(all.low[axis], box.low[axis]);
    all.high[axis] = std::max(all.high[axis], box.high[axis]);
  }
}

// How far boxes are widened. A ray's distances to the planes of a box are (corner - origin) / direction + step * (scale
// / direction): six roundings, each of which moves the plane by at most a unit roundoff of the distance between origin
// and box. Both lie within the scene, or at the eye, or on the disc that distant light starts from, two diameters away.
// Where a ray meets a triangle is as uncertain.
float marginFor(const Box& all, const double (&eye)[3]) {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double low = std::min(eye[axis], double{all.low[axis]}), high = std::max(eye[axis], double{all.high[axis]});
    reach = std::max({reach, std::abs(low), std::abs(high), 3 * (high - low)});
  }
  return static_cast<float>(16 * 0x1p-24 * reach);
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

Box unionOf(const Box* boxes, size_t count) {
  Box all = boxes[0];
  for (size_t i = 1; i < count; ++i) growTo(boxes[i], all);
  return all;
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

BvhFaces makeFaces(const BranchLeaf& leaf, const Pieces& pieces, const PrimitiveRecord<double>* primitives) {
  BvhFaces faces;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const uint32_t id = pieces.ids[leaf.item[std::min<size_t>(slot, leaf.count - 1)]];
    const auto corners = cornersOf(primitives[id & kFacePrimitiveMask], kindOf(id));
    faces.id[slot] = id;
    faces.size[slot] = sizeOf(boxOf(corners));
    for (size_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3; ++axis) faces.corner[k][axis][slot] = corners[k][axis];
    }
  }
  return faces;
}
BvhSpheres makeSpheres(const BranchLeaf& leaf, const Pieces& pieces, const PrimitiveRecord<double>* primitives) {
  BvhSpheres spheres;
  for (size_t slot = 0; slot < kLeafSize; ++slot) {
    const uint32_t id = pieces.ids[leaf.item[std::min<size_t>(slot, leaf.count - 1)]];
    const auto& record = primitives[id & kFacePrimitiveMask];
    spheres.id[slot] = id;
    for (size_t axis = 0; axis < 3; ++axis) spheres.center[axis][slot] = static_cast<float>(record.p0[axis]);
    spheres.radius[slot] = static_cast<float>(record.e1[0]);
  }
  return spheres;
}

}  // namespace

Bvh::Bvh(const PrimitiveRecord<double>* primitives, size_t count, const double (&eye)[3]) {
  Pieces faces, spheres;
  faces.ids.reserve(count);
  faces.boxes.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const auto addFace = [&](FaceKind kind) { faces.add(i, kind, boxOf(cornersOf(primitives[i], kind))); };
    switch (static_cast<PrimitiveKind>(primitives[i].kind)) {
      case PrimitiveKind::triangle:
        addFace(FaceKind::triangle);
        break;
      case PrimitiveKind::quad:
        addFace(FaceKind::lowerHalf);
        addFace(FaceKind::upperHalf);
        break;
      case PrimitiveKind::sphere:
        spheres.add(i, FaceKind::sphere, boxOfSphere(primitives[i]));
        break;
    }
  }
  std::optional<BranchTree> faceTree, sphereTree;
  Box all{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  Counts faceCounts, sphereCounts;
  size_t stack = 0;
  const auto grow = [&](const Pieces& pieces, std::optional<BranchTree>& tree, Counts& counts) {
    if (pieces.ids.empty()) return;
    tree.emplace(pieces.boxes);
    countBranches(tree->root(), counts);
    stack = std::max(stack, stackNeed(tree->root()));
    growTo(unionOf(pieces.boxes.data(), pieces.boxes.size()), all);
  };
  grow(faces, faceTree, faceCounts);
  grow(spheres, sphereTree, sphereCounts);
  // One reference for the other hierarchy, one for the end, and a whole node written at once.
  if (stack + 2 + kBvhWidth > kBvhStack) throw std::runtime_error("the hierarchy is too deep");

  const size_t nodes = faceCounts.nodes + sphereCounts.nodes + 1;
  const size_t used =
      nodes * sizeof(BvhNode) + faceCounts.leaves * sizeof(BvhFaces) + sphereCounts.leaves * sizeof(BvhSpheres);
  if (used / kBvhUnit > kBvhOffsetMask) throw std::runtime_error("the hierarchy is too large");
  arena_ = MemoryBlock(used, sizeof(BvhNode));

  Layout layout(arena_.get(), nodes, marginFor(all, eye));
  view_.arena = arena_.get();
  if (faceTree) {
    view_.root = layout.add(faceTree->root(), BvhEntry::faces,
                            [&](const BranchLeaf& leaf) { return makeFaces(leaf, faces, primitives); });
  }
  if (sphereTree) {
    const uint32_t root = layout.add(sphereTree->root(), BvhEntry::spheres,
                                     [&](const BranchLeaf& leaf) { return makeSpheres(leaf, spheres, primitives); });
    const auto bounds = [](const Pieces& pieces) { return unionOf(pieces.boxes.data(), pieces.boxes.size()); };
    view_.root = faceTree ? layout.join(view_.root, bounds(faces), root, bounds(spheres)) : root;
  }
}

}  // namespace wavecrest
