// A histogram as whole units of probability, and the alias table that draws it (Vose 1991), as kernels read it
// (kernels/columns/guide_view.h).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/columns/guide_view.h"

namespace wavecrest {

// Units of each bin, 2^kGuideUnitBits together; none has them all.
using GuideUnits = std::array<uint32_t, kGuideBins>;

// In proportion to weights that are not negative and not all zero. A bin whose weight rounds to nothing has no unit;
// one that has all the weight leaves a unit to a neighbour.
GuideUnits unitsOf(const std::array<double, kGuideBins>& weights);

// words: of the bins (GuideBin). Every unit of a bin is in exactly one column.
void makeAliasTable(const GuideUnits& units, uint32_t* words);

// Whether kGuideBins words are what makeAliasTable makes: no others draw what they say.
bool isAliasTable(const uint32_t* words);

}  // namespace wavecrest
