// What checkpoints hold of an image: what two have in common, and what a sum lacks.
#include "bench/checkpoint/holdings.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

Holdings runs(std::vector<Holdings::Run> list, uint64_t of = 0, uint32_t parts = 1) {
  Holdings holdings;
  holdings.runs = std::move(list);
  holdings.of = of;
  holdings.parts = parts;
  return holdings;
}

Holdings chains(std::vector<Holdings::ChainShare> list, uint64_t of) {
  Holdings holdings;
  holdings.chains = std::move(list);
  holdings.of = of;
  return holdings;
}

TEST(HoldingsTest, runsJoinAndWhatIsBetweenIsMissing) {
  Holdings sum = runs({{8, 12}}, 16, 4);
  EXPECT_EQ(sum.missing(0), "iterations 0 to 7, 12 to 15 of 16 (parts 1/4, 2/4, 4/4)");
  sum.add(runs({{0, 4}}, 16, 4));
  EXPECT_EQ(sum.missing(0), "iterations 4 to 7, 12 to 15 of 16 (parts 2/4, 4/4)");
  EXPECT_FALSE(sum.goesOn());
  sum.add(runs({{12, 16}}, 16, 4));
  sum.add(runs({{4, 7}}, 16, 4));
  EXPECT_EQ(sum.missing(0), "iterations 7 of 16 (part 2/4)");
  sum.add(runs({{7, 8}}, 16, 4));
  EXPECT_EQ(sum.missing(0), "");
  EXPECT_EQ(sum.runs, (std::vector<Holdings::Run>{{0, 16}}));
  EXPECT_TRUE(sum.goesOn());
  EXPECT_EQ(holdingsFrom(toJson(sum)), sum);
}

TEST(HoldingsTest, samplesThatPixelsLackAreMissing) {
  Holdings uneven = runs({{0, 16}}, 16);
  uneven.lacking = 70;
  EXPECT_EQ(uneven.missing(0), "70 samples of pixels, where a render stopped within an iteration");
  EXPECT_TRUE(uneven.goesOn());
  uneven.add(runs({{16, 20}}, 20));
  EXPECT_FALSE(uneven.goesOn());
}

TEST(HoldingsTest, commonIterationsAreNamed) {
  const Holdings some = runs({{0, 4}, {8, 12}});
  EXPECT_EQ(some.overlap(runs({{4, 8}, {12, 20}})), "");
  EXPECT_EQ(some.overlap(runs({{10, 30}})), "iterations 10 to 11");
  EXPECT_EQ(some.overlap(runs({{3, 8}})), "iterations 3");
}

// Chain c belongs to part c modulo parts, whatever the number of parts.
TEST(HoldingsTest, sharesOfChainsFitInAnyCut) {
  const auto share = [](uint32_t part, uint32_t parts, uint64_t iterations = 9) {
    return Holdings::ChainShare{part, parts, iterations};
  };
  Holdings sum = chains({share(0, 2)}, 9);
  EXPECT_EQ(sum.missing(100), "the chains of part 2/2");
  EXPECT_EQ(sum.overlap(chains({share(1, 4)}, 9)), "");
  EXPECT_EQ(sum.overlap(chains({share(2, 4)}, 9)), "chains of part 3/4");
  EXPECT_EQ(sum.overlap(chains({share(1, 3)}, 9)), "chains of part 2/3");  // chain 4
  sum.add(chains({share(1, 4)}, 9));
  EXPECT_EQ(sum.missing(100), "the chains of part 4/4");
  sum.add(chains({share(3, 4, 5)}, 9));
  EXPECT_EQ(sum.missing(100), "4 of 9 iterations of part 4/4");
  EXPECT_FALSE(sum.goesOn());
  EXPECT_EQ(holdingsFrom(toJson(sum)), sum);
}

}  // namespace
}  // namespace wavecrest
