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
  if (units[largest] == kAll) {
    --units[largest];
    ++units[largest ^ 1];
  }
  return units;
}

void makeAliasTable(const GuideUnits& units, uint32_t* words) {
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
    words[bin] = GuideBin{.units = units[bin], .own = left[bin], .other = giver}.word();
    left[giver] -= kColumn - left[bin];
    if (left[giver] >= kColumn) continue;
    --richCount;
    poor[poorCount++] = giver;
  }
  for (size_t i = 0; i < richCount; ++i) {
    words[rich[i]] = GuideBin{.units = units[rich[i]], .own = 0, .other = rich[i]}.word();
  }
}

bool isAliasTable(const uint32_t* words) {
  GuideUnits units;
  for (size_t bin = 0; bin < kGuideBins; ++bin) units[bin] = GuideBin::of(words[bin]).units;
  if (std::accumulate(units.begin(), units.end(), uint64_t{0}) != uint64_t{1} << kGuideUnitBits) return false;
  std::array<uint32_t, kGuideBins> made{};
  makeAliasTable(units, made.data());
  return std::equal(made.begin(), made.end(), words);
}

}  // namespace wavecrest
