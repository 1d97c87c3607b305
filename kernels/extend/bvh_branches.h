// The shape of a hierarchy before it is laid out: nodes of up to eight children over boxes, by Embree's builder (binned
// surface area heuristic, in parallel).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/bvh.h"

namespace wavecrest {

// A leaf of up to kLeafSize boxes of the input, or a node with the boxes of its children.
struct Branch {
  bool leaf;
  uint32_t count;
};
struct BranchLeaf : Branch {
  uint32_t item[kLeafSize];
};
struct BranchNode : Branch {
  const Branch* child[kBvhWidth];
  Box box[kBvhWidth];
};
inline const BranchLeaf& asLeaf(const Branch& branch) { return static_cast<const BranchLeaf&>(branch); }
inline const BranchNode& asNode(const Branch& branch) { return static_cast<const BranchNode&>(branch); }

class BranchTree {
 public:
  // Throws std::runtime_error with Embree's error number if there is no memory.
  explicit BranchTree(const std::vector<Box>& boxes);
  ~BranchTree();
  BranchTree(const BranchTree&) = delete;
  BranchTree& operator=(const BranchTree&) = delete;

  const Branch& root() const { return *root_; }

 private:
  void* device_ = nullptr;  // RTCDevice
  void* memory_ = nullptr;  // RTCBVH, of which all branches are part
  const Branch* root_ = nullptr;
};

}  // namespace wavecrest
