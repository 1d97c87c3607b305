#include "kernels/extend/bvh_branches.h"

#include <new>
#include <stdexcept>
#include <string>

#include "kernels/extend/embree_packets.h"

namespace wavecrest {
namespace {

constexpr unsigned kMostDepth = 28;  // below it Embree halves what is left: some five levels more

// The builder keeps untyped pointers: always to a Branch.
template <class Kind>
Kind* newBranch(RTCThreadLocalAllocator allocator, bool leaf, size_t count) {
  auto* const branch = new (rtcThreadLocalAlloc(allocator, sizeof(Kind), 16)) Kind;
  branch->leaf = leaf;
  branch->count = static_cast<uint32_t>(count);
  return branch;
}
BranchNode& nodeAt(void* node) { return static_cast<BranchNode&>(*static_cast<Branch*>(node)); }

void* createNode(RTCThreadLocalAllocator allocator, unsigned children, void*) {
  return static_cast<Branch*>(newBranch<BranchNode>(allocator, false, children));
}
void setChildren(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) nodeAt(node).child[i] = static_cast<const Branch*>(children[i]);
}
void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) {
    const RTCBounds& b = *bounds[i];
    nodeAt(node).box[i] = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
  }
}
void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* items, size_t count, void*) {
  auto* const leaf = newBranch<BranchLeaf>(allocator, true, count);
  for (size_t i = 0; i < count; ++i) leaf->item[i] = items[i].primID;
  return static_cast<Branch*>(leaf);
}

}  // namespace

BranchTree::BranchTree(const std::vector<Box>& boxes) {
  std::vector<RTCBuildPrimitive> items(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    const auto& [low, high] = boxes[i];
    items[i] = {low[0], low[1], low[2], 0, high[0], high[1], high[2], static_cast<unsigned>(i)};
  }
  RTCDevice device = rtcNewDevice(nullptr);
  RTCBVH memory = device == nullptr ? nullptr : rtcNewBVH(device);
  if (memory != nullptr) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = kBvhWidth;
    arguments.maxDepth = kMostDepth;
    arguments.sahBlockSize = arguments.minLeafSize = arguments.maxLeafSize = kLeafSize;
    arguments.bvh = memory;
    arguments.primitives = items.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = items.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = createLeaf;
    root_ = static_cast<const Branch*>(rtcBuildBVH(&arguments));
  }
  if (root_ == nullptr) {
    const std::string error = std::to_string(rtcGetDeviceError(device));
    if (memory != nullptr) rtcReleaseBVH(memory);
    if (device != nullptr) rtcReleaseDevice(device);
    throw std::runtime_error("Embree: the hierarchy could not be built (error " + error + ")");
  }
  device_ = device;
  memory_ = memory;
}

BranchTree::~BranchTree() {
  rtcReleaseBVH(static_cast<RTCBVH>(memory_));
  rtcReleaseDevice(static_cast<RTCDevice>(device_));
}

}  // namespace wavecrest
