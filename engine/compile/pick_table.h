// Tables from which an index is picked in proportion to its weight: alias tables of lights, of texels of the sky, and
// others.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/scene_view.h"

namespace wavecrest {

// Kernels choose the entry of a table, and whether it is kept, by random numbers of 24 bits.
inline constexpr size_t kPickNumbers = size_t{1} << 24;

// Entries such that picking one uniformly and keeping it with its probability, else taking its alias, yields each index
// nearly in proportion to its weight (Vose 1991). Weights must be >= 0 with a positive sum. Probabilities are rounded
// up to 2^-24, the grid of random numbers, so the weight of an index is off by at most 2^-24 of an entry, which is much
// for the smallest; sharesOf is how often each is drawn.
std::vector<AliasEntry> makeAliasTable(const std::vector<double>& weights);
// How often kernels choose each of `count` entries, 1 to 2^24, by a random number of 24 bits: with many entries some
// have one number more than others.
std::vector<double> entryShares(size_t count);
// How often each index is drawn from a table whose entries are chosen with the probabilities `chosen`.
std::vector<double> sharesOf(const std::vector<AliasEntry>& table, const std::vector<double>& chosen);

}  // namespace wavecrest
