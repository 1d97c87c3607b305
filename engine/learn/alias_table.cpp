#include "engine/learn/alias_table.h"

#include <algorithm>
#include <numeric>

namespace wavecrest {

GuideUnits unitsOf(const std::array<double, kGuideBins>& weights) {
  constexpr uint32_t kAll = 1u << kGuideUnitBits;
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  GuideUnits units{};
  uint32_t given = 0;
  size_t largest = 0;
  for (size_t bin = 0; bin < kGuideBins; ++bin) {
    units[bin] = std::min(static_cast<uint32_t>(weights[bin] / total * kAll), kAll - given);
    given += units[bin];
    if (weights[bin] > weights[largest]) largest = bin;
  }
  // The largest bin gets what rounding has left.
  units[largest] += kAll - given;
  return units;
}

void makeAliasTable(const GuideUnits& units, uint32_t* entries) {
  constexpr uint32_t kColumn = 1u << kGuideColumnBits;
  GuideUnits left = units;
  std::array<uint32_t, kGuideBins> poor, rich;  // stacks of bins with less than a column, and of the others
  size_t poorCount = 0, richCount = 0;
  for (uint32_t bin = 0; bin < kGuideBins; ++bin) {
    if (left[bin] < kColumn) {
      poor[poorCount++] = bin;
    } else {
      rich[richCount++] = bin;
    }
  }
  // A rich bin fills up the column of each poor one. All bins together have as many units as the columns.
  while (poorCount != 0) {
    const uint32_t bin = poor[--poorCount], giver = rich[richCount - 1];
    entries[bin] = left[bin] << kGuideBinBits | giver;
    left[giver] -= kColumn - left[bin];
    if (left[giver] >= kColumn) continue;
    --richCount;
    poor[poorCount++] = giver;
  }
  for (size_t i = 0; i < richCount; ++i) entries[rich[i]] = kColumn << kGuideBinBits | rich[i];
}

}  // namespace wavecrest
