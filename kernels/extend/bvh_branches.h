// The shape of a hierarchy before it is laid out: nodes of up to eight children over pieces.
//
// Built from above by the binned surface area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
// Hierarchies", RT 2007): of the children that a node has so far, the one of the largest surface is split until there
// are eight. Pieces are put into the order of the leaves in place, so a leaf is a range of them. The result depends on
// the pieces alone and not on how many threads build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/bvh.h"

namespace wavecrest {

// A leaf of `pieces` pieces from index `at` on; or if that is 0, the node of index `at`.
struct Branch {
  uint32_t at, pieces;
  bool isLeaf() const { return pieces != 0; }
};
struct BranchNode {
  uint32_t count = 0;
  Branch child[kBvhWidth];
  Box box[kBvhWidth];
};

struct BranchTree {
  Branch root{};
  Box bounds{};
  std::vector<BranchNode> nodes;

  // pieces: at least one. leafSize: how many a leaf may have.
  BranchTree(Pieces& pieces, const ParallelFor& parallelFor, size_t leafSize = kLeafSize);
};

}  // namespace wavecrest
