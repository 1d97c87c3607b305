#include "engine/learn/cell_tree.h"

#include <algorithm>
#include <utility>

namespace wavecrest {

CellTree::CellTree(const double (&center)[3], const double (&halfExtent)[3], size_t mostCells)
    : mostCells_(std::max<size_t>(mostCells, kCellRoots)) {
  // Nodes never move, because kernels hold their address.
  nodes_.reserve(2 * mostCells_);
  leaves_.reserve(mostCells_);
  for (uint32_t root = 0; root < kCellRoots; ++root) {
    nodes_.push_back(kCellLeaf | root);
    leaves_.push_back({.node = root, .level = 0});
  }
  starts_.resize(kCellStarts);
  publish();
  view_.nodes = nodes_.data();
  view_.starts = starts_.data();
  for (int axis = 0; axis < 3; ++axis) {
    view_.least[axis] = static_cast<float>(center[axis] - halfExtent[axis]);
    view_.scale[axis] = static_cast<float>((1u << kCellBitsOfAxis) / (2 * halfExtent[axis]));
  }
}

uint32_t CellTree::split(uint32_t cell) {
  const auto added = static_cast<uint32_t>(cells()), child = static_cast<uint32_t>(nodes_.size());
  Leaf& leaf = leaves_[cell];
  nodes_[leaf.node] = child;
  leaf = {.node = child, .level = leaf.level + 1};
  nodes_.push_back(kCellLeaf | cell);
  nodes_.push_back(kCellLeaf | added);
  leaves_.push_back({.node = child + 1, .level = leaf.level});
  return added;
}

void CellTree::save(StateWriter& out) const { out.list(nodes_); }

void CellTree::restore(StateReader& in) {
  const std::vector<uint32_t> nodes = in.list<uint32_t>();
  // Each cell but the roots' own has come with two nodes.
  const size_t most = 2 * mostCells_ - kCellRoots;
  if (nodes.size() < kCellRoots || nodes.size() > most || nodes.size() % 2 != 0) {
    throw StateError("it has other cells than this render");
  }
  nodes_.assign(nodes.begin(), nodes.end());
  findLeaves();
  publish();
}

// Visits the tree from its roots. Every node must be reached once, and every cell be one node's.
void CellTree::findLeaves() {
  const size_t cells = (nodes_.size() + kCellRoots) / 2;
  leaves_.assign(cells, {.node = kCellLeaf});
  std::vector<Leaf> waiting;
  for (uint32_t root = 0; root < kCellRoots; ++root) waiting.push_back({.node = root, .level = 0});
  size_t found = 0;
  for (size_t visited = 0; !waiting.empty(); ++visited) {
    const Leaf at = waiting.back();
    waiting.pop_back();
    const uint32_t node = nodes_[at.node], cell = node & ~kCellLeaf;
    const bool isLeaf = (node & kCellLeaf) != 0;
    const bool fits = isLeaf ? cell < cells && leaves_[cell].node == kCellLeaf
                             : node + size_t{1} < nodes_.size() && node > at.node && at.level < kCellLevels;
    if (!fits || visited >= nodes_.size()) throw StateError("its cells are no tree");
    if (isLeaf) {
      leaves_[cell] = at;
      ++found;
      continue;
    }
    waiting.push_back({.node = node + 1, .level = at.level + 1});
    waiting.push_back({.node = node, .level = at.level + 1});
  }
  if (found != cells) throw StateError("its cells are no tree");
}

}  // namespace wavecrest
