// Entry points of guide_entries.cpp: kernels/guide on columns.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/columns/cell_tree.h"
#include "kernels/columns/guide_view.h"

namespace wavecrest {

struct GuideEntries {
  size_t lanes;
  // Of `count` unit directions, columns of a whole number of blocks: the bin, and the solid angle of an area of 1.
  void (*toSquare)(const float* x, const float* y, const float* z, size_t count, uint32_t* bin, float* solidAngle);
  // The directions that a guide's cell 0 draws by the numbers b, c and d, and the densities of these directions.
  void (*draw)(const GuideView& guide, const float* b, const float* c, const float* d, size_t count, float* x, float* y,
               float* z, float* density);
  // The cells of places on surfaces that face along +y or, for a negative place along y, -y.
  void (*cells)(const CellTreeView& tree, const float* x, const float* y, const float* z, size_t count, uint32_t* cell);
};

}  // namespace wavecrest
