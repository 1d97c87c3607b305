#include "kernels/extend/bvh_branches.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <utility>

namespace wavecrest {
namespace {

constexpr size_t kBins = 32;
constexpr size_t kLargeRange = size_t{1} << 16;  // ranges above are split by several threads
constexpr size_t kSampleStride = 8;              // of a large range findSplit counts every eighth piece
// From this depth on pieces are halved by count, which bounds the depth of the tree: a ray's stack has a limit.
constexpr size_t kMostDepth = 24;

// Four numbers at once, of which three count. A type of the compiler's, which every instruction set has.
using Four = float __attribute__((vector_size(16)));
// Reads one word past the three coordinates of a Piece. The fourth number is never used.
Four loadFour(const float* from) {
  Four value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
Four least(Four a, Four b) { return a < b ? a : b; }
Four most(Four a, Four b) { return a > b ? a : b; }

// A box that grows. It begins empty.
struct Bounds {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  Four low{kFar, kFar, kFar, kFar}, high{-kFar, -kFar, -kFar, -kFar};

  void add(Four otherLow, Four otherHigh) {
    low = least(low, otherLow);
    high = most(high, otherHigh);
  }
  void add(const Bounds& other) { add(other.low, other.high); }
  // Half of the surface; 0 of nothing.
  float area() const {
    const Four size = high - low;
    return size[0] >= 0 ? size[0] * size[1] + size[1] * size[2] + size[2] * size[0] : 0;
  }
  Box box() const { return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}; }
};

// Pieces [begin, end), the box of them and that of their centres, the latter times two.
struct Range {
  uint32_t begin = 0, end = 0;
  Bounds all, centers;

  uint32_t size() const { return end - begin; }
  void add(const Piece& piece) {
    const Four low = loadFour(piece.low), high = loadFour(piece.high);
    all.add(low, high);
    const Four center = low + high;
    centers.add(center, center);
  }
  void add(const Range& other) {
    all.add(other.all);
    centers.add(other.centers);
  }
};

// Which bin a centre falls into along each axis.
class BinScale {
 public:
  BinScale(const Range& range, size_t bins) : low_(range.centers.low), last_(static_cast<int>(bins) - 1) {
    const Four extent = range.centers.high - range.centers.low;
    for (size_t axis = 0; axis < 3; ++axis) {
      // A little less than bins / extent, so that the greatest centre falls into the last bin. 0 where the centres do
      // not differ: no split is looked for along such an axis.
      const float scale = static_cast<float>(bins) * 0.9999f / extent[axis];
      scale_[axis] = extent[axis] > 0 && scale < std::numeric_limits<float>::max() ? scale : 0;
    }
  }
  bool splits(size_t axis) const { return scale_[axis] > 0; }
  // The bin of a piece. Like Range::centers, centres are times two.
  size_t operator()(const Piece& piece, size_t axis) const {
    return static_cast<size_t>(
        std::clamp(static_cast<int>((piece.low[axis] + piece.high[axis] - low_[axis]) * scale_[axis]), 0, last_));
  }

 private:
  Four low_, scale_{0, 0, 0, 0};
  int last_;
};

// For each axis and bin, the box and the number of the pieces whose centres fall into it.
struct Bins {
  Bounds bounds[3][kBins];
  uint32_t counts[3][kBins]{};

  // Counts every piece whose distance from `begin` is a multiple of the stride.
  void add(const Piece* begin, const Piece* end, size_t stride, const BinScale& scale) {
    const auto count = static_cast<size_t>(end - begin);
    for (size_t i = 0; i < count; i += stride) {
      const Piece& piece = begin[i];
      const Four low = loadFour(piece.low), high = loadFour(piece.high);
      for (size_t axis = 0; axis < 3; ++axis) {
        const size_t bin = scale(piece, axis);
        bounds[axis][bin].add(low, high);
        ++counts[axis][bin];
      }
    }
  }
  void add(const Bins& other, size_t bins) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t i = 0; i < bins; ++i) {
        bounds[axis][i].add(other.bounds[axis][i]);
        counts[axis][i] += other.counts[axis][i];
      }
    }
  }
};

struct Split {
  size_t axis = 0, bin = 0;  // bins below go to one side
  float cost = std::numeric_limits<float>::infinity();
  bool found() const { return cost < std::numeric_limits<float>::infinity(); }
};

// The split of the least sum of areas times leaves.
Split bestSplit(const Bins& bins, size_t count, const BinScale& scale, size_t leafSize) {
  const auto leavesFor = [=](size_t pieces) { return (pieces + leafSize - 1) / leafSize; };
  Split best;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!scale.splits(axis)) continue;
    // From the last bin downwards: the cost of the bins from i on, for every i.
    float costAbove[kBins];
    Bounds above;
    uint32_t piecesAbove = 0;
    for (size_t i = count; i-- > 1;) {
      above.add(bins.bounds[axis][i]);
      piecesAbove += bins.counts[axis][i];
      costAbove[i] = above.area() * static_cast<float>(leavesFor(piecesAbove));
    }
    // From the first bin upwards: the cost of the bins below i, and with the other side the cost of the split.
    const uint32_t all = piecesAbove + bins.counts[axis][0];
    Bounds below;
    uint32_t pieces = 0;
    for (size_t i = 1; i < count; ++i) {
      below.add(bins.bounds[axis][i - 1]);
      pieces += bins.counts[axis][i - 1];
      if (pieces == 0 || pieces == all) continue;
      const float cost = below.area() * static_cast<float>(leavesFor(pieces)) + costAbove[i];
      if (cost < best.cost) best = {axis, i, cost};
    }
  }
  return best;
}

// Memory for nodes, which stay where they are: threads take blocks of it, and nodes from their blocks.
class NodeMemory {
 public:
  // pieces: of the tree. A small tree gets no more than it can use, as there may be thousands of them.
  explicit NodeMemory(size_t pieces)
      : block_(std::min(pieces, kBlock)), blocksAtOnce_(pieces > kLargeRange ? kBlocksAtOnce : 1) {}

  size_t block() const { return block_; }
  // Room for block() nodes, not initialised.
  BranchNode* take() {
    const std::lock_guard lock(mutex_);
    if (left_ == 0) {
      memory_.emplace_back(blocksAtOnce_ * block_ * sizeof(BranchNode), alignof(BranchNode));
      left_ = blocksAtOnce_;
    }
    --left_;
    return reinterpret_cast<BranchNode*>(memory_.back().get()) + left_ * block_;
  }
  std::vector<MemoryBlock> release() { return std::move(memory_); }

 private:
  // A large tree takes more at once than malloc ever keeps for itself when it is freed (32 MB).
  static constexpr size_t kBlock = 256, kBlocksAtOnce = (size_t{64} << 20) / (kBlock * sizeof(BranchNode));
  size_t block_, blocksAtOnce_;
  std::mutex mutex_;
  std::vector<MemoryBlock> memory_;
  size_t left_ = 0;  // blocks of the last memory that nobody has taken
};

// The nodes that one thread makes in a row.
class NodeBlock {
 public:
  explicit NodeBlock(NodeMemory& memory) : memory_(memory) {}
  BranchNode& take() {
    if (left_ == 0) {
      next_ = memory_.take();
      left_ = memory_.block();
    }
    --left_;
    return *next_++;
  }

 private:
  NodeMemory& memory_;
  BranchNode* next_ = nullptr;
  size_t left_ = 0;
};

struct Subtree {
  const BranchNode* node = nullptr;
  BranchTotals totals{.nodes = 0, .leaves = 1, .stack = 1};  // of a leaf
};

class Builder {
 public:
  Builder(Piece* pieces, NodeMemory& memory, const ParallelFor& parallelFor, size_t leafSize)
      : pieces_(pieces), memory_(memory), parallelFor_(parallelFor), leafSize_(leafSize) {}

  Range whole(size_t count) const {
    Range range{.begin = 0, .end = static_cast<uint32_t>(count), .all = {}, .centers = {}};
    measure(range);
    return range;
  }
  // Sorts the pieces of a leaf by their ids.
  void sortLeaf(const Range& range) const {
    std::sort(pieces_ + range.begin, pieces_ + range.end, [](const Piece& a, const Piece& b) { return a.id < b.id; });
  }
  // The node of a range, which is no leaf, and all below it. nodes: where this thread takes its nodes from.
  Subtree build(const Range& range, size_t depth, NodeBlock& nodes) const {
    // Split the child of the largest surface until there are eight children, or all of them are leaves.
    Range children[kBvhWidth] = {range};
    size_t count = 1;
    while (count < kBvhWidth) {
      size_t widest = kBvhWidth;
      for (size_t i = 0; i < count; ++i) {
        if (isLeaf(children[i])) continue;
        if (widest == kBvhWidth || children[i].all.area() > children[widest].all.area()) widest = i;
      }
      if (widest == kBvhWidth) break;
      const auto [first, second] = split(children[widest], depth);
      children[widest] = first;
      children[count++] = second;
    }

    // Build the subtrees. Below a large range each is a task of its own, with its own block of nodes.
    BranchNode& node = nodes.take();
    Subtree subtrees[kBvhWidth];
    if (range.size() > kLargeRange) {
      parallelFor_(count, [&](size_t i) {
        NodeBlock own(memory_);
        if (!isLeaf(children[i])) subtrees[i] = build(children[i], depth + 1, own);
      });
    } else {
      for (size_t i = 0; i < count; ++i) {
        if (!isLeaf(children[i])) subtrees[i] = build(children[i], depth + 1, nodes);
      }
    }

    // Write the node. A walk that goes on with one child leaves the others on its stack.
    Subtree built{.node = &node, .totals = {.nodes = 1, .leaves = 0, .stack = 0}};
    node.count = static_cast<uint32_t>(count);
    for (size_t i = 0; i < count; ++i) {
      const auto& [below, totals] = subtrees[i];
      if (below == nullptr) sortLeaf(children[i]);
      node.box[i] = children[i].all.box();
      node.child[i] = {below, children[i].begin, below == nullptr ? children[i].size() : 0};
      built.totals.nodes += totals.nodes;
      built.totals.leaves += totals.leaves;
      built.totals.stack = std::max(built.totals.stack, count - 1 + totals.stack);
    }
    return built;
  }

 private:
  bool isLeaf(const Range& range) const { return range.size() <= leafSize_; }

  // Finds both boxes of a range from its pieces.
  void measure(Range& range) const {
    std::vector<Range> parts(range.size() / kLargeRange + 1);
    parallelFor_(parts.size(), [&](size_t i) {
      const size_t first = range.begin + i * kLargeRange;
      for (size_t k = first; k < std::min<size_t>(range.end, first + kLargeRange); ++k) parts[i].add(pieces_[k]);
    });
    for (const Range& part : parts) range.add(part);
  }

  // Two ranges in place of one that is too large for a leaf. Both have pieces.
  std::pair<Range, Range> split(const Range& range, size_t depth) const {
    const size_t bins = std::min<size_t>(kBins, 4 + range.size() / 8);
    const BinScale scale(range, bins);
    const Split best = depth < kMostDepth ? findSplit(range, scale, bins) : Split{};
    if (!best.found()) return halve(range);
    return partition(range, [&](const Piece& piece) { return scale(piece, best.axis) < best.bin; });
  }

  // Large ranges are read from memory as often as they are split: most of the time that a builder takes beyond a linear
  // one. A sample of ten thousand pieces finds a split as good.
  Split findSplit(const Range& range, const BinScale& scale, size_t bins) const {
    Bins all;
    if (range.size() <= kLargeRange) {
      all.add(pieces_ + range.begin, pieces_ + range.end, 1, scale);
      return bestSplit(all, bins, scale, leafSize_);
    }
    constexpr size_t kPart = kSampleStride * kLargeRange;
    std::vector<Bins> parts((range.size() + kPart - 1) / kPart);
    parallelFor_(parts.size(), [&](size_t i) {
      const size_t first = range.begin + i * kPart;
      parts[i].add(pieces_ + first, pieces_ + std::min<size_t>(range.end, first + kPart), kSampleStride, scale);
    });
    for (const Bins& part : parts) all.add(part, bins);
    return bestSplit(all, bins, scale, leafSize_);
  }

  // Puts the pieces for which isBelow holds before the others, in place, and measures both sides on the way.
  template <class IsBelow>
  std::pair<Range, Range> partition(const Range& range, const IsBelow& isBelow) const {
    Range below{.begin = range.begin, .end = 0, .all = {}, .centers = {}},
        above{.begin = 0, .end = range.end, .all = {}, .centers = {}};
    Piece *left = pieces_ + range.begin, *right = pieces_ + range.end;
    while (true) {
      while (left != right && isBelow(*left)) below.add(*left++);
      while (left != right && !isBelow(right[-1])) above.add(*--right);
      if (left == right) break;
      std::swap(*left, right[-1]);
    }
    below.end = above.begin = static_cast<uint32_t>(left - pieces_);
    return {below, above};
  }
  // Where no plane parts the centres: any half is as good as another.
  std::pair<Range, Range> halve(const Range& range) const {
    const uint32_t middle = range.begin + range.size() / 2;
    Range first{.begin = range.begin, .end = middle, .all = {}, .centers = {}},
        second{.begin = middle, .end = range.end, .all = {}, .centers = {}};
    measure(first);
    measure(second);
    return {first, second};
  }

  Piece* pieces_;
  NodeMemory& memory_;
  const ParallelFor& parallelFor_;
  size_t leafSize_;
};

}  // namespace

BranchTree::BranchTree(Pieces& pieces, const ParallelFor& parallelFor, size_t leafSize) {
  NodeMemory memory(pieces.size());
  const Builder builder(pieces.begin(), memory, parallelFor, leafSize);
  const Range whole = builder.whole(pieces.size());
  bounds = whole.all.box();
  NodeBlock nodes(memory);
  const Subtree tree = pieces.size() > leafSize ? builder.build(whole, 0, nodes) : Subtree{};
  if (tree.node == nullptr) builder.sortLeaf(whole);
  totals = tree.totals;
  root = {tree.node, 0, tree.node == nullptr ? static_cast<uint32_t>(pieces.size()) : 0};
  nodes_ = memory.release();
}

}  // namespace wavecrest
