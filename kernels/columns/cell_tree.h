// Cells of the scene: by place, and by the side that a surface faces. What a render learns, it learns by cell.
//
// Six binary trees, one for each direction of the axes that the surface's normal is nearest to. A tree halves the
// scene's box along x, y and z in turn, so a cell is relative to the box: the size of a scene never decides what is
// learned. The engine splits cells (engine/learn/cell_tree.h); kernels look them up (kernels/guide/cell_lanes.h).
#pragma once

#include <cstdint>

namespace wavecrest {

// Roots: normals nearest to +x, -x, +y, -y, +z, -z. Levels: ten halvings along each axis.
constexpr uint32_t kCellRoots = 6, kCellBitsOfAxis = 10, kCellLevels = 3 * kCellBitsOfAxis;
constexpr uint32_t kCellLeaf = 1u << 31;

// Levels of the tree that a table of starts stands for, three halvings along each axis.
constexpr uint32_t kCellStartLevels = 9, kCellStarts = kCellRoots << kCellStartLevels;

struct CellTreeView {
  // The first kCellRoots nodes are the roots. A node is kCellLeaf plus its cell, or the index of the first of its two
  // children.
  const uint32_t* nodes = nullptr;
  // Where the first kCellStartLevels halvings lead, root by root: the node there, or the leaf that is reached before.
  const uint32_t* starts = nullptr;
  // scale (p - least) is in [0, 2^kCellBitsOfAxis] for places p in the box.
  float least[3]{}, scale[3]{};
};

// The starts of a tree. starts: kCellStarts of them.
inline void fillCellStarts(const uint32_t* nodes, uint32_t* starts) {
  for (uint32_t start = 0; start < kCellStarts; ++start) {
    uint32_t node = nodes[start >> kCellStartLevels];
    for (uint32_t level = kCellStartLevels; level-- != 0 && node < kCellLeaf;) {
      node = nodes[node + (start >> level & 1)];
    }
    starts[start] = node;
  }
}

}  // namespace wavecrest
