// The shape of a hierarchy before it is laid out: nodes of up to eight children over boxes, by Embree's builder (binned
// surface area heuristic, in parallel).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/extend/bvh.h"

namespace wavecrest {

struct Box {
  float low[3], high[3];
};

// A node with the boxes of its children, or a leaf of up to kLeafSize boxes of the input.
struct Branch {
  uint32_t count;
  bool leaf;
  const Branch* child[kBvhWidth];
  Box box[kBvhWidth];
  uint32_t item[kLeafSize];
};

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
