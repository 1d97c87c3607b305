// Who sends to whom, and which contributions make a sum.
#include "bench/ranks/sum_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace wavecrest {
namespace {

SumTree::Bytes contributionOfOne(uint32_t rank) { return {static_cast<unsigned char>(rank + 1)}; }

TEST(SumTreeTest, everyProcessIsTheChildOfItsParent) {
  for (uint32_t ranks = 1; ranks <= 70; ++ranks) {
    uint32_t children = 0;
    for (uint32_t rank = 0; rank < ranks; ++rank) {
      const SumTree tree(rank, ranks);
      for (const uint32_t child : tree.children()) {
        EXPECT_EQ(SumTree(child, ranks).parent(), rank);
        EXPECT_LT(child, ranks);
        EXPECT_GT(child, rank);
      }
      children += static_cast<uint32_t>(tree.children().size());
      EXPECT_LE(tree.children().size(), 7u);
    }
    EXPECT_EQ(children, ranks - 1);
  }
}

TEST(SumTreeTest, contributionsComeInTheOrderOfProcessesWhateverThatOfArrival) {
  SumTree tree(0, 5);  // of which 1, 2 and 4 send here
  EXPECT_TRUE(tree.take(3, 4, contributionOfOne(4), false).empty());
  EXPECT_TRUE(tree.take(3, 0, contributionOfOne(0), false).empty());
  EXPECT_TRUE(tree.take(3, 2, contributionOfOne(2), false).empty());
  EXPECT_TRUE(tree.take(3, 2, contributionOfOne(2), false).empty());  // a second time
  EXPECT_TRUE(tree.take(3, 3, contributionOfOne(3), false).empty());  // is none of its children
  const auto all = tree.take(3, 1, contributionOfOne(1), false);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all.front().contributions, (std::vector<SumTree::Bytes>{{1}, {2}, {3}, {5}}));
  EXPECT_EQ(tree.waiting(), 0u);
}

// A process that was told to stop contributes to the end and not to the snapshots before.
TEST(SumTreeTest, whatWillNeverBeCompleteIsDropped) {
  SumTree tree(0, 2);
  EXPECT_TRUE(tree.take(snapshotLabel(5), 0, contributionOfOne(0), false).empty());
  EXPECT_TRUE(tree.take(snapshotLabel(6), 0, contributionOfOne(0), false).empty());
  EXPECT_TRUE(tree.take(saveLabel(0), 0, contributionOfOne(0), false).empty());
  EXPECT_EQ(tree.take(snapshotLabel(6), 1, contributionOfOne(1), false).size(), 1u);
  EXPECT_EQ(tree.waiting(), 1u);  // saves are asked for at any time
  EXPECT_EQ(tree.take(saveLabel(0), 1, contributionOfOne(1), false).size(), 1u);
  EXPECT_TRUE(tree.take(snapshotLabel(7), 0, contributionOfOne(0), false).empty());
  EXPECT_TRUE(tree.take(saveLabel(1), 0, contributionOfOne(0), false).empty());
  EXPECT_TRUE(tree.take(kFinalLabel, 1, contributionOfOne(1), false).empty());
  EXPECT_EQ(tree.take(kFinalLabel, 0, contributionOfOne(0), false).size(), 1u);
  EXPECT_EQ(tree.waiting(), 0u);
}

// Of three processes, 1 is done after snapshot 4; 0 and 2 go on.
TEST(SumTreeTest, whatIsDoneStandsForLaterSnapshotsAndSaves) {
  SumTree tree(0, 3);
  const auto labels = [&](SumLabel label, uint32_t from, SumTree::Bytes contribution) {
    std::vector<SumLabel> complete;
    for (const auto& one : tree.take(label, from, std::move(contribution), true)) complete.push_back(one.label);
    return complete;
  };
  using Labels = std::vector<SumLabel>;
  for (const unsigned number : {5u, 6u}) {
    EXPECT_EQ(labels(snapshotLabel(number), 0, {1}), Labels{});
    EXPECT_EQ(labels(snapshotLabel(number), 2, {3}), Labels{});
  }
  EXPECT_EQ(labels(snapshotLabel(7), 0, {1}), Labels{});
  EXPECT_EQ(labels(kFinalLabel, 1, {20}), (Labels{snapshotLabel(5), snapshotLabel(6)}));
  EXPECT_EQ(labels(saveLabel(0), 0, {1}), Labels{});
  EXPECT_EQ(labels(saveLabel(0), 2, {3}), Labels{saveLabel(0)});
  const auto seventh = tree.take(snapshotLabel(7), 2, {3}, true);
  ASSERT_EQ(seventh.size(), 1u);
  EXPECT_EQ(seventh.front().contributions, (std::vector<SumTree::Bytes>{{1}, {20}, {3}}));
  EXPECT_EQ(labels(kFinalLabel, 0, {10}), Labels{});
  const auto end = tree.take(kFinalLabel, 2, {30}, true);
  ASSERT_EQ(end.size(), 1u);
  EXPECT_EQ(end.front().contributions, (std::vector<SumTree::Bytes>{{10}, {20}, {30}}));
  EXPECT_EQ(tree.waiting(), 0u);
}

}  // namespace
}  // namespace wavecrest
