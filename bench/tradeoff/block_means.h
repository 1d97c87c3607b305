// Images as means of blocks of 8 x 8 pixels, and the bias that several of them show.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/tradeoff/tradeoff.h"

namespace wavecrest {

using BlockMeans = std::vector<double>;  // of all three channels together, row by row; the image's mean comes last

BlockMeans blockMeans(std::span<const float> film, uint32_t width);

struct BlockComparison {
  Bias mean, worstBlock;
};

// Of the same seeds with the same paths: Student's test of the differences. At least two of each.
BlockComparison comparePaired(std::span<const BlockMeans> own, std::span<const BlockMeans> reference);
// Of independent seeds: Welch's test (1947).
BlockComparison compareIndependent(std::span<const BlockMeans> own, std::span<const BlockMeans> reference);

}  // namespace wavecrest
