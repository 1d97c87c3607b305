// What a campaign cannot judge, and why it says so: what was not measured, what the reference's noise hides, runs that
// are too short or cannot be compared.
#include <gtest/gtest.h>

#include "bench/claims/judge_claims.h"
#include "tests/bench/claims/made_up_results.h"

namespace wavecrest {
namespace {

TEST(JudgeClaims, whatWasNotMeasuredIsNotJudgedAndSaid) {
  const Condition better = condition(ConditionKind::better, "rmse", {"mlt", "pt"}, {"lt"});
  const MadeUp made =
      MadeUp().with("pt", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01}).with("mlt", "rmse", {1, 1.01});
  const ClaimRecord absent = made.judge(better), refused = MadeUp(made).refuse("mlt-pathspace").judge(better);
  EXPECT_EQ(absent.verdict, kNotJudged) << "the study's mlt is that of path space";
  EXPECT_EQ(absent.figure, "mlt-pathspace was not measured");
  EXPECT_EQ(refused.verdict, kNotJudged);
  EXPECT_EQ(refused.figure, "mlt-pathspace was refused");
  EXPECT_EQ(MadeUp(made).curve("mlt-pathspace", "rmse", {}).judge(better).figure, "mlt-pathspace was not measured")
      << "a run that is done, without a snapshot";
  EXPECT_EQ(MadeUp(made).with("mlt-pathspace", "rmse", {1, 1.01}).verdict(better), kHolds);
  const Condition wrongToo = condition(ConditionKind::better, "rmse", {"mlt", "lt"}, {"pt"});
  EXPECT_EQ(made.verdict(wrongToo), kFails) << "what was measured is enough to refute";
}

TEST(JudgeClaims, whatWasNotMeasuredRefutesNothing) {
  Condition behind = condition(ConditionKind::behind, "rmse", {"bpt"}, {"pt", "lt"});
  Condition leads = condition(ConditionKind::leads, "rmse", {"bpt", "vcm"}, {"pt", "lt"});
  Condition poor = condition(ConditionKind::poor, "rmse", {"bpt"}, {"pt", "lt", "ppm"});
  const auto made = [](double bpt) {
    return MadeUp().with("pt", "rmse", {1, 1.01}).with("bpt", "rmse", {bpt, 1.01 * bpt});
  };
  EXPECT_EQ(made(0.5).verdict(behind), kNotJudged) << "lt may be ahead";
  EXPECT_EQ(made(0.5).with("lt", "rmse", {2, 2.01}).verdict(behind), kFails);
  EXPECT_EQ(made(2).verdict(leads), kNotJudged) << "vcm may lead";
  EXPECT_EQ(made(2).with("vcm", "rmse", {2, 2.01}).verdict(leads), kFails) << "of pt, whatever lt has";
  poor.factor = 1.5;
  EXPECT_EQ(made(2).with("lt", "rmse", {2, 2.01}).verdict(poor), kNotJudged) << "one of two, and one open";
  EXPECT_EQ(made(1).with("lt", "rmse", {2, 2.01}).verdict(poor), kFails) << "one of three is no majority";
}

TEST(JudgeClaims, nearTheReferencesNoiseWhatIsNotShownIsNotJudged) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"}),
                  opposite = condition(ConditionKind::better, "rmse", {"lt"}, {"pt"}),
                  faster = condition(ConditionKind::faster, "rmse", {"pt"}, {"lt"});
  // Both are mostly the reference's noise, which is the same for both.
  const MadeUp apart = MadeUp().with("pt", "rmse", {1.2, 1.201}).with("lt", "rmse", {1.1, 1.101}).floor("rmse", 1.0);
  EXPECT_EQ(apart.verdict(better), kFails);
  EXPECT_EQ(apart.verdict(opposite), kHolds);
  EXPECT_EQ(apart.verdict(faster), kFails);
  const MadeUp overlapping = MadeUp().with("pt", "rmse", {1.15, 1.2}).with("lt", "rmse", {1.1, 1.18});
  EXPECT_EQ(overlapping.verdict(better), kUndecided);
  EXPECT_EQ(MadeUp(overlapping).floor("rmse", 1.0).verdict(better), kNotJudged);
  EXPECT_EQ(MadeUp(overlapping).floor("rmse", 1.0).verdict(faster), kNotJudged);
  EXPECT_EQ(MadeUp(overlapping).floor("rmse", 0.1).verdict(better), kUndecided);
}

TEST(JudgeClaims, nearTheReferencesNoiseLossesWithinAFactorMayBeBeyondIt) {
  Condition good = condition(ConditionKind::good, "rmse", {"pt"}, {"lt"}),
            opposite = condition(ConditionKind::good, "rmse", {"lt"}, {"pt"});
  good.factor = opposite.factor = 1.5;
  const MadeUp apart = MadeUp().with("pt", "rmse", {1.2, 1.201}).with("lt", "rmse", {1.1, 1.101});
  EXPECT_EQ(apart.verdict(good), kHolds);
  EXPECT_EQ(MadeUp(apart).floor("rmse", 1.0).verdict(good), kNotJudged);
  EXPECT_EQ(MadeUp(apart).floor("rmse", 1.0).verdict(opposite), kHolds) << "lt is the better one";
}

// Runs whose searches meet 0.02 of the study's light paths. They have a twelfth of its paths per pixel.
TEST(JudgeClaims, claimsNeedLightPathsAndTime) {
  const char* const stats = R"({"iterations": 100, "light_paths": 1572864, "camera_paths": 1572864, "width": 128,
                                "height": 64, "radius": 0.001})";
  const MadeUp made = MadeUp().with("ppm", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01}).stats(stats);
  Claim claim{.id = "c",
              .scene = "s",
              .statement = "so",
              .conditions = {condition(ConditionKind::better, "rmse", {"ppm"}, {"lt"})}};
  EXPECT_EQ(judgeClaim(claim, made.results()).verdict, kHolds);
  claim.needs.lightPaths = 0.5;
  const ClaimRecord starved = judgeClaim(claim, made.results());
  EXPECT_EQ(starved.verdict, kNotJudged);
  EXPECT_EQ(starved.figure, "a search of ppm meets 0.02 of the study's light paths; needs 0.5");
  EXPECT_FALSE(starved.evidence.empty());
  claim.needs.lightPaths = 0.019;
  EXPECT_EQ(judgeClaim(claim, made.results()).verdict, kHolds);
  claim.needs.paths = 0.1;
  EXPECT_EQ(judgeClaim(claim, made.results()).figure, "lt made 0.044 of the study's paths per pixel; needs 0.1");
  // Of methods that merge, iterations count and not the light paths of each.
  const char* const rich = R"({"iterations": 100, "light_paths": 25165824, "camera_paths": 1572864, "width": 128,
                               "height": 64, "radius": 0.001})";
  claim.conditions = {condition(ConditionKind::better, "rmse", {"ppm"}, {"ppm"})};
  EXPECT_EQ(judgeClaim(claim, MadeUp(made).stats(rich).results()).figure,
            "ppm made 0.044 of the study's paths per pixel; needs 0.1");
  claim.conditions = {condition(ConditionKind::better, "rmse", {"ppm"}, {"lt"})};
  claim.needs = {.lightPaths = 0.3};
  const char* const wide = R"({"iterations": 100, "light_paths": 1572864, "radius": 0.004})";
  EXPECT_EQ(judgeClaim(claim, MadeUp(made).stats(wide).results()).verdict, kHolds) << "16 times the area of search";
}

// A campaign that is being extended has runs of two lengths.
TEST(JudgeClaims, runsOfUnequalTimeAreNotCompared) {
  MadeUp made = MadeUp().with("ppm", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01}).stats(R"({"asked_seconds": 45})");
  const Claim claim{.id = "c",
                    .scene = "s",
                    .statement = "so",
                    .conditions = {condition(ConditionKind::better, "rmse", {"ppm"}, {"lt"})}};
  EXPECT_EQ(judgeClaim(claim, made.results()).verdict, kHolds);
  CampaignResults extended = made.results();
  extended.runs.front().stats = R"({"asked_seconds": 90})";
  const ClaimRecord record = judgeClaim(claim, extended);
  EXPECT_EQ(record.verdict, kNotJudged);
  EXPECT_EQ(record.figure, "runs of 45 s and of 90 s stand side by side");
  extended.runs.front().stats = R"({"asked_seconds": 1440})";
  EXPECT_EQ(judgeClaim(claim, extended).figure, "runs of 45 s and of 1440 s stand side by side");
}

// A campaign that went on elsewhere: at equal times its runs have other numbers of paths.
TEST(JudgeClaims, runsOfTwoProcessorsAreNotCompared) {
  Claim claim{.id = "c",
              .scene = "s",
              .statement = "so",
              .conditions = {condition(ConditionKind::worseHere, "rmse", {"ppm"}, {"lt"})}};
  claim.conditions[0].control = "box";
  CampaignResults results = MadeUp()
                                .with("ppm", "rmse", {1, 1.01})
                                .with("lt", "rmse", {1, 1.01})
                                .scene("box")
                                .with("ppm", "rmse", {2, 2.01})
                                .with("lt", "rmse", {1, 1.01})
                                .stats(R"({"cpu": "A"})")
                                .results();
  EXPECT_EQ(judgeClaim(claim, results).verdict, kHolds);
  CampaignResults mixed = results;
  mixed.runs.back().stats = R"({"cpu": "B"})";
  EXPECT_EQ(judgeClaim(claim, mixed).verdict, kNotJudged);
  EXPECT_EQ(judgeClaim(claim, mixed).figure, "runs of two processors stand side by side: A and B");
  mixed.runs.back().stats = "{}";
  mixed.campaign["cpu"] = "B, A";
  EXPECT_EQ(judgeClaim(claim, mixed).verdict, kNotJudged) << "stats without one are of the first";
  results.runs.front().stats = R"({"cpu": "B"})";
  EXPECT_EQ(judgeClaim(claim, results).figure,
            "in box, the control, runs of two processors stand side by side: A and B");
  results.runs.front().stats = R"({"cpu": "A", "threads": 4})";
  results.runs[1].stats = R"({"cpu": "A", "threads": 2})";
  EXPECT_EQ(judgeClaim(claim, results).figure, "in box, the control, runs of 2 and of 4 threads stand side by side");
}

}  // namespace
}  // namespace wavecrest
