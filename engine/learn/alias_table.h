// A histogram as whole units of probability, and the alias table that draws it (Vose 1991), as kernels read it
// (kernels/columns/guide_view.h).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/columns/guide_view.h"

namespace wavecrest {

// Units of each bin, 2^kGuideUnitBits together.
using GuideUnits = std::array<uint32_t, kGuideBins>;

// In proportion to weights that are not negative and not all zero; a bin whose weight rounds to nothing has no unit.
GuideUnits unitsOf(const std::array<double, kGuideBins>& weights);

// entries: of the bins' columns. Every unit of a bin is in exactly one column.
void makeAliasTable(const GuideUnits& units, uint32_t* entries);

}  // namespace wavecrest
