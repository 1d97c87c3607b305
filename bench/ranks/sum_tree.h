// Who adds up what: the processes of a render as a binomial tree, whose root, process 0, gets the sum of all.
//
// Process r sends to r without its lowest bit, and adds what r + 1, r + 2, r + 4, ... below that bit have sent: each
// process adds log2(n) contributions at most, and always in the same order, so that sums have the same bits each time.
// Contributions are told apart by labels. Labels of one kind are used in ascending order by every process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

namespace wavecrest {

using SumLabel = uint64_t;
// Of snapshots, by their number; of saves on request; of the end of the render.
constexpr SumLabel snapshotLabel(unsigned number) { return number; }
constexpr SumLabel kFirstSaveLabel = SumLabel{1} << 62;
constexpr SumLabel saveLabel(uint64_t number) { return kFirstSaveLabel + number; }
constexpr SumLabel kFinalLabel = std::numeric_limits<SumLabel>::max();
constexpr bool isSnapshot(SumLabel label) { return label < kFirstSaveLabel; }
constexpr bool isSave(SumLabel label) { return !isSnapshot(label) && label != kFinalLabel; }

class SumTree {
 public:
  using Bytes = std::vector<unsigned char>;

  SumTree(uint32_t rank, uint32_t ranks);

  uint32_t parent() const { return rank_ & (rank_ - 1); }  // not of the root
  const std::vector<uint32_t>& children() const { return children_; }

  // All contributions to a label: this process' own first, then those of children in their order.
  struct Complete {
    SumLabel label = 0;
    std::vector<Bytes> contributions;
  };

  // Takes a contribution of this process or of a child. Returns what is complete now, in ascending order. Drops
  // contributions that will never be complete: those of earlier labels of the same kind, and with the last label all.
  // lastStands: a process that is done contributes to no more labels, and its last contribution stands for those. Not
  // so after a stop, when it may be from before they were due.
  std::vector<Complete> take(SumLabel label, uint32_t from, Bytes contribution, bool lastStands);

  // Labels that wait for contributions.
  size_t waiting() const { return pending_.size(); }

 private:
  uint32_t rank_;
  std::vector<uint32_t> children_;
  std::map<SumLabel, std::vector<Bytes>> pending_;  // empty where they are missing
};

}  // namespace wavecrest
