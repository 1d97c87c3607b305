// What a guide is to kernels: for each cell (cell_tree.h) a histogram of directions that paths may go on in.
//
// Directions are places in a square: the octahedron |x| + |y| + |z| = 1 with its lower half folded outwards
// (kernels/guide/square_lanes.h). The square has kGuideSide x kGuideSide bins. A histogram is an alias table of whole
// units, so what is drawn has exactly the density that is stated. At a vertex the direction comes from the BSDF with
// the probability `share` of the cell, else from the histogram (METHODS 12.1).
#pragma once

#include <cstdint>

namespace wavecrest {

constexpr uint32_t kGuideSideBits = 4, kGuideSide = 1u << kGuideSideBits, kGuideBins = kGuideSide * kGuideSide;
constexpr uint32_t kGuideBinBits = 2 * kGuideSideBits;
// Units of probability: as many as a random number of 24 bits tells apart. A column of the alias table has this many.
constexpr uint32_t kGuideUnitBits = 24, kGuideColumnBits = kGuideUnitBits - kGuideBinBits;

struct GuideView {
  const float* share = nullptr;    // of each cell: probability of the BSDF; 1 where the cell has no histogram
  const float* density = nullptr;  // of each bin, kGuideBins to a cell: density per area of the square [-1,1]^2
  // Of each bin: in the upper bits how many units of its column are its own, in the lowest kGuideBinBits the bin that
  // has the others.
  const uint32_t* alias = nullptr;
  bool draws = false;  // any share is below 1
};

// The least and greatest share of the BSDF where there is a histogram.
constexpr float kLeastBsdfShare = 0.1f, kMostBsdfShare = 0.95f;

}  // namespace wavecrest
