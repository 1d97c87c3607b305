// The shape of a hierarchy before it is laid out: nodes of up to eight children over pieces.
//
// Built from above by the binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
// Hierarchies", RT 2007): of the children that a node has so far, the one of the largest surface is split until there
// are eight. Pieces are put into the order of the leaves in place, so a leaf is a range of them. Within a leaf they are
// in the order of their ids: of equally near hits rays take that of the lowest (BvhRay::keep). The result depends on
// the pieces alone and not on how many threads build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/bvh.h"

namespace wavecrest {

struct BranchNode;
// A node; or without one, a leaf of `pieces` pieces from index `first` on.
struct Branch {
  const BranchNode* node;
  uint32_t first, pieces;
  bool isLeaf() const { return node == nullptr; }
};
struct BranchNode {
  uint32_t count;  // children
  Branch child[kBvhWidth];
  Box box[kBvhWidth];
};

// What a branch and all below it amount to.
struct BranchTotals {
  size_t nodes = 0, leaves = 0;
  size_t stack = 0;  // the most references that a walk leaves on its stack
};

struct BranchTree {
  Branch root{};
  Box bounds{};
  BranchTotals totals;

  // pieces: at least one. leafSize: how many a leaf may have.
  BranchTree(Pieces& pieces, const ParallelFor& parallelFor, size_t leafSize = kLeafSize);

 private:
  std::vector<MemoryBlock> nodes_;
};

}  // namespace wavecrest
