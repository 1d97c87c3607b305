// How many rounds of paired runs fit into a requested duration.
#include "bench/against/against.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

TEST(Rounds, fillTheTimeAlsoWhereARunIsLong) {
  EXPECT_EQ(roundsOf(20, 0.25), 40u);
  EXPECT_EQ(roundsOf(20, 0.5), 20u);
  EXPECT_EQ(roundsOf(100, 2), 25u);
}

TEST(Rounds, areEnoughForAVerdictAndNoMoreThanOfRunsOfAQuarterOfASecond) {
  EXPECT_EQ(roundsOf(20, 3), kFewestRounds);
  EXPECT_EQ(roundsOf(0.2, 0.008), kFewestRounds);
  EXPECT_EQ(roundsOf(20, 0.1), 40u);
}

}  // namespace
}  // namespace wavecrest
