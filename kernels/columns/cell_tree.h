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

struct CellTreeView {
  // The first kCellRoots nodes are the roots. A node is kCellLeaf plus its cell, or the index of the first of its two
  // children.
  const uint32_t* nodes = nullptr;
  // scale (p - least) is in [0, 2^kCellBitsOfAxis] for places p in the box.
  float least[3]{}, scale[3]{};
};

}  // namespace wavecrest
