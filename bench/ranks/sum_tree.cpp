#include "bench/ranks/sum_tree.h"

#include <algorithm>
#include <utility>

namespace wavecrest {

SumTree::SumTree(uint32_t rank, uint32_t ranks) : rank_(rank) {
  for (uint32_t bit = 1; (rank & bit) == 0 && rank + bit < ranks; bit <<= 1) children_.push_back(rank + bit);
}

std::vector<SumTree::Complete> SumTree::take(SumLabel label, uint32_t from, Bytes contribution, bool lastStands) {
  const auto child = std::find(children_.begin(), children_.end(), from);
  if (from != rank_ && child == children_.end()) return {};
  const size_t place = from == rank_ ? 0 : static_cast<size_t>(child - children_.begin()) + 1;
  std::vector<Bytes>& pending = pending_[label];
  pending.resize(1 + children_.size());
  if (!pending[place].empty()) return {};
  pending[place] = std::move(contribution);
  // A last contribution may complete several labels; its own comes last.
  std::vector<Complete> complete;
  const auto last = lastStands ? pending_.find(kFinalLabel) : pending_.end();
  for (auto& [each, contributions] : pending_) {
    bool whole = true;
    for (size_t i = 0; i < contributions.size(); ++i) {
      whole &= !contributions[i].empty() || (last != pending_.end() && !last->second[i].empty());
    }
    if (!whole) continue;
    for (size_t i = 0; i < contributions.size(); ++i) {
      if (contributions[i].empty()) contributions[i] = last->second[i];
    }
    complete.push_back({each, std::move(contributions)});
  }
  // Each process contributes in order: whoever has not contributed to an earlier label never will.
  for (const Complete& one : complete) {
    std::erase_if(pending_, [&](const auto& entry) {
      return entry.first == one.label || one.label == kFinalLabel ||
             (entry.first < one.label && isSnapshot(entry.first) == isSnapshot(one.label));
    });
  }
  return complete;
}

}  // namespace wavecrest
