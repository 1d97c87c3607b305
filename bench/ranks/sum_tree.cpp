#include "bench/ranks/sum_tree.h"

#include <algorithm>
#include <utility>

namespace wavecrest {

SumTree::SumTree(uint32_t rank, uint32_t ranks) : rank_(rank) {
  for (uint32_t bit = 1; (rank & bit) == 0 && rank + bit < ranks; bit <<= 1) children_.push_back(rank + bit);
}

std::optional<std::vector<SumTree::Bytes>> SumTree::take(SumLabel label, uint32_t from, Bytes contribution) {
  const auto child = std::find(children_.begin(), children_.end(), from);
  if (from != rank_ && child == children_.end()) return std::nullopt;
  const size_t place = from == rank_ ? 0 : static_cast<size_t>(child - children_.begin()) + 1;
  Pending& pending = pending_[label];
  pending.contributions.resize(1 + children_.size());
  if (!pending.contributions[place].empty()) return std::nullopt;
  pending.contributions[place] = std::move(contribution);
  if (++pending.count < pending.contributions.size()) return std::nullopt;
  std::vector<Bytes> all = std::move(pending.contributions);
  // Each process contributes in order: whoever has not contributed to an earlier label never will.
  std::erase_if(pending_, [&](const auto& entry) {
    return entry.first == label || label == kFinalLabel ||
           (entry.first < label && isSnapshot(entry.first) == isSnapshot(label));
  });
  return all;
}

}  // namespace wavecrest
