// Cells of the scene (kernels/columns/cell_tree.h), which split where a render learns most.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/state/state_stream.h"
#include "kernels/columns/cell_tree.h"

namespace wavecrest {

class CellTree {
 public:
  // One cell for each root, over the box of this centre and half extent, which is positive. mostCells: no split makes
  // more, at least kCellRoots.
  CellTree(const double (&center)[3], const double (&halfExtent)[3], size_t mostCells);

  // Valid as long as the tree.
  const CellTreeView& view() const { return view_; }
  size_t cells() const { return leaves_.size(); }
  size_t mostCells() const { return mostCells_; }
  // Whether split(cell) may be called: the cell is not as small as cells get, and there may be one more.
  bool canSplit(uint32_t cell) const { return leaves_[cell].level < kCellLevels && cells() < mostCells_; }
  // Halves a cell: one half keeps its number, the other gets the next new one, which is returned. publish() is to
  // follow, once for all splits.
  uint32_t split(uint32_t cell);
  // Makes what kernels read follow from the cells.
  void publish() { fillCellStarts(nodes_.data(), starts_.data()); }

  void save(StateWriter& out) const;
  // Throws StateError if the bytes are not those of a tree with at most mostCells() cells.
  void restore(StateReader& in);

  static size_t bytesOfCell() { return 2 * sizeof(uint32_t) + sizeof(Leaf); }

 private:
  struct Leaf {
    uint32_t node = 0, level = 0;
  };
  void findLeaves();

  size_t mostCells_;
  std::vector<uint32_t> nodes_;
  std::vector<Leaf> leaves_;  // by cell
  std::vector<uint32_t> starts_;
  CellTreeView view_;
};

}  // namespace wavecrest
