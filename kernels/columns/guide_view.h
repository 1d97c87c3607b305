// What a guide is to kernels: for each cell (cell_tree.h) a histogram of directions that paths may go on in.
//
// Directions are places in a square: the octahedron |x| + |y| + |z| = 1 with its lower half folded outwards
// (kernels/guide/square_lanes.h). The square has kGuideSide x kGuideSide bins. A histogram is an alias table of whole
// units, so what is drawn has exactly the density that is stated. At a vertex the direction comes from the BSDF with
// the probability `share` of the cell, else from the histogram (METHODS 12.1).
//
// A cell's histogram is 1 KB: lookups go to random places of all of them, so their size is what guiding costs.
#pragma once

#include <cstdint>

namespace wavecrest {

constexpr uint32_t kGuideSideBits = 4, kGuideSide = 1u << kGuideSideBits, kGuideBins = kGuideSide * kGuideSide;
constexpr uint32_t kGuideBinBits = 2 * kGuideSideBits;
// Units of probability: 2^kGuideUnitBits in all, 2^kGuideColumnBits in each column of the alias table.
constexpr uint32_t kGuideUnitBits = 16, kGuideColumnBits = kGuideUnitBits - kGuideBinBits;

// A bin with its column of the alias table in one word.
struct GuideBin {
  static constexpr uint32_t kUnitShift = kGuideBinBits + kGuideColumnBits, kOwnShift = kGuideBinBits;

  uint32_t units;  // of the bin, below 2^kGuideUnitBits
  uint32_t own;    // of the column, below 2^kGuideColumnBits: so many units are the bin's own,
  uint32_t other;  // and the bin that has all others: the bin itself where its own fill the column

  constexpr uint32_t word() const { return units << kUnitShift | own << kOwnShift | other; }
  static constexpr GuideBin of(uint32_t word) {
    return {word >> kUnitShift, word >> kOwnShift & ((1u << kGuideColumnBits) - 1), word & (kGuideBins - 1)};
  }
};
// Density per area of the square [-1,1]^2 of a bin with one unit: a bin has the area 4 / kGuideBins.
constexpr float kGuideDensityOfUnit = kGuideBins / 4.0f / (1u << kGuideUnitBits);

struct GuideView {
  const float* share = nullptr;    // of each cell: probability of the BSDF; 1 where the cell has no histogram
  const uint32_t* bins = nullptr;  // words of GuideBin, kGuideBins to a cell
  // A path's worth (engine/learn/path_worth.h) is luminance of its throughput x root of its cell x perBrightness of its
  // run of kWorthRun pixels in the order of waves. roots: root mean square of what came back to each cell, 0 where it
  // is not known yet. perBrightness: scale / brightness of the pixels; none as long as it is not known.
  const float* roots = nullptr;
  const float* perBrightness = nullptr;
  bool decidesSurvival = false;
};
constexpr uint32_t kWorthRunBits = 6, kWorthRun = 1u << kWorthRunBits;  // pixels

// The least and greatest share of the BSDF where there is a histogram.
constexpr float kLeastBsdfShare = 0.1f, kMostBsdfShare = 0.95f;

}  // namespace wavecrest
