#include "engine/compile/pick_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wavecrest {

std::vector<AliasEntry> makeAliasTable(const std::vector<double>& weights) {
  constexpr double kNumberGrid = static_cast<double>(kPickNumbers);  // on which the probability of `keep` is exact
  const size_t count = weights.size();
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  // Scale the weights to a mean of 1, and tell those below 1 from the others.
  std::vector<double> scaled(count);
  std::vector<uint32_t> small, large;
  for (size_t i = 0; i < count; ++i) {
    scaled[i] = weights[i] / sum * static_cast<double>(count);
    (scaled[i] < 1 ? small : large).push_back(static_cast<uint32_t>(i));
  }
  std::vector<AliasEntry> table(count);
  for (size_t i = 0; i < count; ++i) table[i] = {1.0f, static_cast<uint32_t>(i)};
  // A large entry fills what a small one leaves of its slot, and keeps the rest.
  while (!small.empty() && !large.empty()) {
    const uint32_t less = small.back(), more = large.back();
    small.pop_back();
    const double keep = std::ceil(scaled[less] * kNumberGrid) / kNumberGrid;
    table[less] = {static_cast<float>(keep), more};
    scaled[more] -= 1 - keep;
    if (scaled[more] < 1) {
      large.pop_back();
      small.push_back(more);
    }
  }
  return table;  // what is left over differs from 1 by rounding only
}

std::vector<double> entryShares(size_t count) {
  const auto entryOf = [count](size_t i) {
    const float number = static_cast<float>(i) / static_cast<float>(kPickNumbers);
    return std::min(static_cast<size_t>(number * static_cast<float>(count)), count - 1);
  };
  std::vector<double> shares;
  size_t first = 0;  // number that chooses entry i
  for (size_t i = 0; i < count; ++i) {
    size_t end = (i + 1) * kPickNumbers / count;
    while (end < kPickNumbers && entryOf(end) <= i) ++end;
    while (end > first && entryOf(end - 1) > i) --end;
    shares.push_back(static_cast<double>(end - first) / static_cast<double>(kPickNumbers));
    first = end;
  }
  return shares;
}

std::vector<double> sharesOf(const std::vector<AliasEntry>& table, const std::vector<double>& chosen) {
  std::vector<double> shares(table.size(), 0);
  for (size_t i = 0; i < table.size(); ++i) {
    const auto keep = static_cast<double>(table[i].keep);
    shares[i] += keep * chosen[i];
    shares[table[i].other] += (1 - keep) * chosen[i];
  }
  return shares;
}

}  // namespace wavecrest
