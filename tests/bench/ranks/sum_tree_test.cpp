// Who sends to whom, and which contributions make a sum.
#include "bench/ranks/sum_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

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
  EXPECT_FALSE(tree.take(3, 4, contributionOfOne(4)));
  EXPECT_FALSE(tree.take(3, 0, contributionOfOne(0)));
  EXPECT_FALSE(tree.take(3, 2, contributionOfOne(2)));
  EXPECT_FALSE(tree.take(3, 2, contributionOfOne(2)));  // a second time
  EXPECT_FALSE(tree.take(3, 3, contributionOfOne(3)));  // is none of its children
  const auto all = tree.take(3, 1, contributionOfOne(1));
  ASSERT_TRUE(all);
  EXPECT_EQ(*all, (std::vector<SumTree::Bytes>{{1}, {2}, {3}, {5}}));
  EXPECT_EQ(tree.waiting(), 0u);
}

// A process that was told to stop contributes to the end and not to the snapshots before.
TEST(SumTreeTest, whatWillNeverBeCompleteIsDropped) {
  SumTree tree(0, 2);
  EXPECT_FALSE(tree.take(snapshotLabel(5), 0, contributionOfOne(0)));
  EXPECT_FALSE(tree.take(snapshotLabel(6), 0, contributionOfOne(0)));
  EXPECT_FALSE(tree.take(saveLabel(0), 0, contributionOfOne(0)));
  EXPECT_TRUE(tree.take(snapshotLabel(6), 1, contributionOfOne(1)));
  EXPECT_EQ(tree.waiting(), 1u);  // saves are asked for at any time
  EXPECT_TRUE(tree.take(saveLabel(0), 1, contributionOfOne(1)));
  EXPECT_FALSE(tree.take(snapshotLabel(7), 0, contributionOfOne(0)));
  EXPECT_FALSE(tree.take(saveLabel(1), 0, contributionOfOne(0)));
  EXPECT_FALSE(tree.take(kFinalLabel, 1, contributionOfOne(1)));
  EXPECT_TRUE(tree.take(kFinalLabel, 0, contributionOfOne(0)));
  EXPECT_EQ(tree.waiting(), 0u);
}

}  // namespace
}  // namespace wavecrest
