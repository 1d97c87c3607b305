// Scores that runs miss for want of time alone: where the slope of their loss leads to them, and where it does not.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "bench/claims/scene_losses.h"
#include "tests/bench/claims/made_up_results.h"

namespace wavecrest {
namespace {

// pt has to have an SSIM of 0.9.
Condition reachesScore() {
  Condition reaches = condition(ConditionKind::reaches, "ssim", {"pt"});
  reaches.score = 0.9;
  return reaches;
}
// Runs of 16 s whose SSIM is 1 - scale / t^power, of so few paths that the study had more time than is asked for here.
MadeUp falling(MadeUp made, const std::string& method, double scale, double power) {
  std::vector<double> scores;
  for (unsigned k = 0; k < 5; ++k) scores.push_back(1 - scale * std::pow(2.0, -power * k));
  return made.curve(method, "ssim", scores).stats(kFewPaths);
}

TEST(JudgeClaims, aScoreThatIsReachedLaterIsNotReachedInThisTime) {
  // 0.8 / sqrt(t) is 0.2 at the end and 0.1 after 64 s. Points on a line tell it without error; curves that bend make
  // it 4^0.75 times as long or as short.
  const ClaimRecord later = falling(MadeUp(), "pt", 0.8, 0.5).judge(reachesScore());
  EXPECT_EQ(later.verdict, kNotReached);
  EXPECT_EQ(later.figure, "SSIM of pt is 0.8; at this rate 0.9 after 64 s (23 to 180 s)");
  // Points about the line leave no more room.
  const ClaimRecord noisy =
      MadeUp().curve("pt", "ssim", {0.2, 0.43, 0.602, 0.715, 0.802}).stats(kFewPaths).judge(reachesScore());
  EXPECT_EQ(noisy.verdict, kNotReached);
  EXPECT_EQ(noisy.figure, "SSIM of pt is 0.802; at this rate 0.9 after 63 s (23 to 170 s)");
  // Nor do two seeds, with times of 60.5 and 67.7 s: 12.7 standard errors of the logarithm are a factor of 2.
  const ClaimRecord seeds = falling(falling(MadeUp(), "pt", 0.778, 0.5), "pt", 0.823, 0.5).judge(reachesScore());
  EXPECT_EQ(seeds.verdict, kNotReached);
  EXPECT_EQ(seeds.figure, "SSIM of pt is 0.8; at this rate 0.9 after 64 s (23 to 180 s)");
  // Only a score that has to be reached can be missed for want of time.
  Condition misses = reachesScore();
  misses.kind = ConditionKind::misses;
  EXPECT_EQ(falling(MadeUp(), "pt", 0.3, 0.5).verdict(misses), kFails);
}

TEST(JudgeClaims, aMissedScoreNeverReadsAsTheLimit) {
  const ClaimRecord missed = MadeUp().curve("pt", "ssim", {0.8996, 0.8996, 0.8996}).judge(reachesScore());
  EXPECT_EQ(missed.figure, "SSIM of pt is 0.8996, limit 0.9");
  const ClaimRecord nearer = MadeUp().curve("pt", "ssim", {0.89999, 0.89999, 0.89999}).judge(reachesScore());
  EXPECT_EQ(nearer.figure, "SSIM of pt is 0.89999, limit 0.9");
}

// Both are least squares through the points after 4, 8 and 16 s.
TEST(SceneLosses, slopeOfALossIsThatOfTheLineToATime) {
  const MadeUp made = MadeUp().curve("pt", "ssim", {0.2, 0.43, 0.602, 0.715, 0.802});
  const SceneLosses scene("s", made.results());
  const auto time = scene.timeToLoss("pt", "ssim", 0.1);
  ASSERT_TRUE(time);
  EXPECT_NEAR(scene.lossSlopes("pt", "ssim", 16).at(0), time->slope.mean, 1e-12);
}

TEST(JudgeClaims, aLossThatFallsTooSlowlyOrNotAtAllDoesNotReachTheScore) {
  // 0.2 at the end, and half of it after 2^(1 / power) times as long: 91 and 114 times.
  EXPECT_EQ(falling(MadeUp(), "pt", 0.2 * std::pow(16, 1 / 6.5), 1 / 6.5).verdict(reachesScore()), kNotReached);
  EXPECT_EQ(falling(MadeUp(), "pt", 0.2 * std::pow(16, 1 / 7.0), 1 / 7.0).verdict(reachesScore()), kFails);
  EXPECT_EQ(falling(MadeUp(), "pt", 0.2, 0).verdict(reachesScore()), kFails) << "flat";
  EXPECT_EQ(falling(MadeUp(), "pt", 0.1, -0.25).verdict(reachesScore()), kFails) << "rises";
  const ClaimRecord wavers = MadeUp().curve("pt", "ssim", {0.2, 0.4, 0.7, 0.85, 0.82}).judge(reachesScore());
  EXPECT_EQ(wavers.verdict, kFails) << "falls, but not beyond the interval of the slope";
  EXPECT_EQ(wavers.figure, "SSIM of pt is 0.82, limit 0.9");
  EXPECT_EQ(MadeUp().curve("pt", "ssim", {0.6, 0.7}).verdict(reachesScore()), kFails) << "two points tell no rate";
}

// Four times as long as the runs, which had this share of the study's 8,789 paths per pixel.
TEST(JudgeClaims, aScoreThatTakesMoreThanTheStudysPathsIsMissed) {
  const auto verdict = [](double share) {
    const std::string stats = R"({"width": 10, "height": 10, "camera_paths": )" + std::to_string(878'906 * share) + "}";
    return falling(MadeUp(), "pt", 0.8, 0.5).stats(stats).verdict(reachesScore());
  };
  EXPECT_EQ(verdict(0.2), kNotReached);
  EXPECT_EQ(verdict(0.3), kFails);
  EXPECT_EQ(falling(MadeUp(), "pt", 0.8, 0.5).stats("").verdict(reachesScore()), kFails) << "paths are not known";
}

TEST(JudgeClaims, anIntervalIsOpenBeyondAHundredTimesTheRun) {
  const ClaimRecord later = falling(MadeUp(), "pt", 0.2 * std::pow(16, 1 / 6.5), 1 / 6.5).judge(reachesScore());
  EXPECT_EQ(later.figure, "SSIM of pt is 0.8; at this rate 0.9 after 1400 s (49 s or longer)");
}

TEST(JudgeClaims, oneOfSeveralConditionsOrMethodsThatFailsDecides) {
  Condition both = reachesScore();
  both.methods = {"pt", "lt", "bpt"};
  const auto made = [](double lt) { return falling(falling(MadeUp(), "pt", 0.8, 0.5), "lt", lt, lt == 0.8 ? 0.4 : 0); };
  const ClaimRecord last = falling(made(0.8), "bpt", 0.1, 0.5).judge(both);
  EXPECT_EQ(last.verdict, kNotReached);
  EXPECT_EQ(last.figure, "SSIM of lt is 0.736; at this rate 0.9 after 180 s (29 to 1100 s)") << "the last to reach it";
  EXPECT_EQ(falling(made(0.2), "bpt", 0.1, 0.5).verdict(both), kFails) << "lt does not get better";
  EXPECT_EQ(made(0.8).verdict(both), kNotReached) << "though bpt was not measured";
  // Beside another condition.
  const auto verdict = [&](Condition other) {
    const MadeUp results = falling(made(0.8), "bpt", 0.1, 0.5);
    return judgeClaim({.id = "c", .scene = "s", .statement = "so", .conditions = {reachesScore(), std::move(other)}},
                      results.results())
        .verdict;
  };
  EXPECT_EQ(verdict(condition(ConditionKind::better, "ssim", {"bpt"}, {"pt"})), kNotReached) << "which holds";
  EXPECT_EQ(verdict(condition(ConditionKind::better, "ssim", {"pt"}, {"bpt"})), kFails);
  EXPECT_EQ(verdict(condition(ConditionKind::biased, "", {"pt"})), kNotReached) << "which cannot be judged";
}

TEST(JudgeClaims, ofGeneralClaimsAScoreNotReachedInThisTimeLeavesItsSceneOpen) {
  Claim claim{.id = "c",
              .scene = "general",
              .statement = "so",
              .conditions = {reachesScore()},
              .scenes = {"box", "room"},
              .atLeast = 2};
  const auto verdict = [&](double power) {
    MadeUp made = falling(falling(MadeUp(), "pt", 0.1, 0.5).scene("box"), "pt", 0.8, power).scene("room");
    return judgeClaim(claim, made.results()).verdict;
  };
  EXPECT_EQ(verdict(0.5), kUndecided) << "holds in box, and may in room";
  EXPECT_EQ(verdict(0), kFails);
  claim.atLeast = 1;
  EXPECT_EQ(verdict(0.5), kHolds);
}

}  // namespace
}  // namespace wavecrest
