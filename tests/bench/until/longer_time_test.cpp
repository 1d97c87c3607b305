// What a render whose time was too short asks for.
#include "bench/until/longer_time.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

TEST(RoundedUpSeconds, haveTwoDigitsOrAreWhole) {
  EXPECT_EQ(roundedUpSeconds(0), "0");
  EXPECT_EQ(roundedUpSeconds(0.0141), "0.015");
  EXPECT_EQ(roundedUpSeconds(1.41), "1.5");
  EXPECT_EQ(roundedUpSeconds(9.93), "10");
  EXPECT_EQ(roundedUpSeconds(14.9), "15");
  EXPECT_EQ(roundedUpSeconds(99.5), "100");
  EXPECT_EQ(roundedUpSeconds(120), "120");
  EXPECT_EQ(roundedUpSeconds(86400.5), "86401");
}

TEST(LongerTime, isThatOfAWholePass) {
  EXPECT_EQ(longerTime(30, 0, 0.25), "more than 120 s");
  EXPECT_EQ(longerTime(30.1, 0, 0.25), "more than 121 s");
  EXPECT_EQ(longerTime(2, 0, 3), "more than 2 s");
}

TEST(LongerTime, hasTrialsOnce) {
  EXPECT_EQ(longerTime(30, 20, 0.5), "more than 40 s");
  EXPECT_EQ(longerTime(1, 2, 0.5), "more than 2 s") << "trials of a render that goes on may take longer than before";
  EXPECT_EQ(longerTime(1.9, 1.84, 0), "more than the 1.9 s that trials take");
  EXPECT_EQ(longerTime(0.1, 0, 0), "a longer time");
}

}  // namespace
}  // namespace wavecrest
