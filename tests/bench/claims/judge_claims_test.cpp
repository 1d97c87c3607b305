// Every kind of condition on made-up results: once where it holds, once where it does not, once where noise decides.
#include "bench/claims/judge_claims.h"

#include <gtest/gtest.h>

#include "tests/bench/claims/made_up_results.h"

namespace wavecrest {
namespace {

TEST(JudgeClaims, better) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt", "bpt"});
  const auto made = [](const std::vector<double>& bpt) {
    return MadeUp().with("pt", "rmse", {1.0, 1.01}).with("lt", "rmse", {3.0, 3.01}).with("bpt", "rmse", bpt);
  };
  EXPECT_EQ(made({2.0, 2.01}).verdict(better), kHolds);
  EXPECT_EQ(made({0.5, 0.501}).verdict(better), kFails);
  EXPECT_EQ(made({1.0, 1.02}).verdict(better), kUndecided);
  EXPECT_EQ(made({0.2, 20.0}).verdict(better), kUndecided) << "a wide band decides nothing";
}

TEST(JudgeClaims, scoresWhereMoreIsBetterTurnIntoLosses) {
  const Condition better = condition(ConditionKind::better, "ssim", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "ssim", {0.98, 0.981}).with("lt", "ssim", {0.9, 0.901}).verdict(better), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "ssim", {0.9, 0.901}).with("lt", "ssim", {0.98, 0.981}).verdict(better), kFails);
  const Condition mos = condition(ConditionKind::better, "q_mos", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "q_mos", {98, 98.1}).with("lt", "q_mos", {90, 90.1}).verdict(mos), kHolds);
}

TEST(JudgeClaims, goodAndPoorAreAboutAFactor) {
  Condition good = condition(ConditionKind::good, "rmse", {"bpt"}, {"lt", "vcm"});
  Condition poor = condition(ConditionKind::poor, "rmse", {"bpt"}, {"lt", "vcm"});
  good.factor = poor.factor = 2;
  const auto made = [](const std::vector<double>& bpt) {
    return MadeUp().with("lt", "rmse", {1.0, 1.01}).with("vcm", "rmse", {1.5, 1.51}).with("bpt", "rmse", bpt);
  };
  EXPECT_EQ(made({1.5, 1.51}).verdict(good), kHolds);
  EXPECT_EQ(made({1.5, 1.51}).verdict(poor), kFails);
  EXPECT_EQ(made({2.5, 2.51}).verdict(good), kFails);
  EXPECT_EQ(made({2.5, 2.51}).verdict(poor), kFails) << "beyond the factor of one of two is not more than half";
  EXPECT_EQ(made({3.5, 3.51}).verdict(poor), kHolds);
  EXPECT_EQ(made({2.0, 2.02}).verdict(good), kUndecided);
  EXPECT_EQ(made({3.0, 3.02}).verdict(poor), kUndecided);
  poor.than.emplace_back("ppm");
  EXPECT_EQ(made({2.5, 2.51}).with("ppm", "rmse", {1.1, 1.11}).verdict(poor), kHolds) << "two of three are enough";
}

TEST(JudgeClaims, fasterIsAboutTheTimeToEqualQuality) {
  const Condition faster = condition(ConditionKind::faster, "rmse", {"pt"}, {"lt"});
  // Both fall by a factor of 2 over a factor of 4 in time: what ends at 2/3 of the other's error is there in 4/9 of it.
  const ClaimRecord record = MadeUp().with("pt", "rmse", {1.0, 1.01}).with("lt", "rmse", {1.5, 1.51}).judge(faster);
  EXPECT_EQ(record.verdict, kHolds);
  EXPECT_EQ(record.figure, "to RMSE 1.5 pt takes 1.78 s, lt 3.99 s");
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1.5, 1.51}).with("lt", "rmse", {1.0, 1.01}).verdict(faster), kFails);
  // Both are as good as at the end at once, so who was first is not seen.
  const MadeUp atOnce = MadeUp().with("pt", "rmse", {1, 1}, 1).with("lt", "rmse", {1, 1}, 1);
  EXPECT_EQ(atOnce.verdict(faster), kUndecided);
  EXPECT_EQ(MadeUp(atOnce).delay("lt", 1.1).verdict(faster), kUndecided) << "lt may have had it before its snapshot";
  EXPECT_EQ(MadeUp(atOnce).delay("pt", 1.1).verdict(faster), kUndecided);
  for (int k = 1; k < 100; ++k) {
    const double loss = 1 + 0.01 * k;
    const MadeUp tie = MadeUp().with("pt", "rmse", {loss, loss}, 1).with("lt", "rmse", {loss, loss}, 1);
    EXPECT_EQ(MadeUp(tie).delay("lt", 1.1).verdict(faster), kUndecided) << loss << ": rounding decides nothing";
  }
  // An upper bound of the sooner one decides: pt has at once what lt has at the end.
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1}, 1).with("lt", "rmse", {1, 1}, 2).verdict(faster), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1}, 2).with("lt", "rmse", {1, 1}, 1).verdict(faster), kFails);
  // Ahead at the end by little, but only after a start far behind: no sooner at the quality that both reach.
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1.0, 1.3}, 9).with("lt", "rmse", {1.1, 1.2}, 1.5).verdict(faster), kUndecided);
}

TEST(JudgeClaims, fasterIsAboutTheTimeFromWhichOnTheQualityStays) {
  const Condition faster = condition(ConditionKind::faster, "rmse", {"vcm"}, {"pt"});
  // pt is as good as at its end already after a second, before it finds the caustics that it has no means for.
  const ClaimRecord record =
      MadeUp().curve("pt", "rmse", {1, 2, 3, 2, 1}).curve("vcm", "rmse", {4, 2, 1, 0.5, 0.25}).judge(faster);
  EXPECT_EQ(record.verdict, kHolds);
  EXPECT_EQ(record.figure, "to RMSE 1 vcm takes 4 s, pt 16 s");
  const ClaimRecord longer = MadeUp()
                                 .curve("pt", "rmse", {1, 2, 3, 2, 1})
                                 .curve("vcm", "rmse", {4, 2, 1, 0.5, 0.25})
                                 .delay("pt", 100)
                                 .judge(faster);
  EXPECT_EQ(longer.figure, "to RMSE 1 vcm takes 4 s, pt 1600 s") << "no power of ten";
}

TEST(JudgeClaims, leadsAndBehind) {
  Condition leads = condition(ConditionKind::leads, "rmse", {"bpt", "vcm"}, {"pt", "lt"});
  leads.factor = 1.1;
  const Condition behind = condition(ConditionKind::behind, "rmse", {"bpt"}, {"pt", "lt"});
  const auto made = [](const std::vector<double>& bpt) {
    return MadeUp()
        .with("pt", "rmse", {1.0, 1.01})
        .with("lt", "rmse", {3.0, 3.01})
        .with("vcm", "rmse", {4.0, 4.01})
        .with("bpt", "rmse", bpt);
  };
  EXPECT_EQ(made({0.9, 0.91}).verdict(leads), kHolds) << "one of the two is enough";
  EXPECT_EQ(made({2.0, 2.01}).verdict(leads), kFails) << "pt is ahead of both";
  EXPECT_EQ(made({2.0, 2.01}).verdict(behind), kHolds) << "of pt, though not of lt";
  EXPECT_EQ(made({0.9, 0.91}).verdict(behind), kFails);
}

TEST(JudgeClaims, worseHereComparesWithTheControl) {
  Condition worse = condition(ConditionKind::worseHere, "rmse", {"ppm"}, {"bpt"});
  worse.factor = 1.5;
  worse.control = "box";
  const auto made = [](double there) {
    return MadeUp()
        .with("ppm", "rmse", {there, 1.01 * there})
        .with("bpt", "rmse", {1.0, 1.01})
        .scene("box")
        .with("ppm", "rmse", {4.0, 4.01})
        .with("bpt", "rmse", {1.0, 1.01});
  };
  EXPECT_EQ(made(1.2).verdict(worse), kHolds);
  EXPECT_EQ(made(4.0).verdict(worse), kFails) << "it is as far behind in the control";
  worse.control = "room";
  EXPECT_EQ(made(1.2).verdict(worse), kNotJudged);
}

// Losses near the reference's noise have a ratio near 1, whatever the true one.
TEST(JudgeClaims, worseHereIsNotJudgedByAControlThatTheNoiseHides) {
  Condition worse = condition(ConditionKind::worseHere, "ssim", {"ppm"}, {"bpt"});
  worse.factor = 1.5;
  worse.control = "box";
  const auto verdict = [&](double noise) {
    CampaignResults results = MadeUp()
                                  .with("ppm", "ssim", {0.988, 0.9881})
                                  .with("bpt", "ssim", {0.99, 0.9901})
                                  .scene("box")
                                  .with("ppm", "ssim", {0.6, 0.601})
                                  .with("bpt", "ssim", {0.8, 0.801})
                                  .results();
    results.scenes.back().noiseFloors["ssim"] = 1 - noise;
    return judgeClaim({.id = "c", .scene = "s", .statement = "so", .conditions = {worse}}, results).verdict;
  };
  EXPECT_EQ(verdict(0.001), kHolds);
  EXPECT_EQ(verdict(0.009), kNotJudged);
}

TEST(JudgeClaims, evidenceNamesEachMethodThatWasNotMeasured) {
  const MadeUp lt = MadeUp().with("lt", "rmse", {1, 1.01});
  const std::string evidence = lt.judge(condition(ConditionKind::better, "rmse", {"bpt", "lt"}, {"pt"})).evidence;
  EXPECT_NE(evidence.find("bpt was not measured"), std::string::npos) << evidence;
  EXPECT_NE((" " + evidence).find(" pt was not measured"), std::string::npos) << evidence;
}

TEST(JudgeClaims, equal) {
  Condition equal = condition(ConditionKind::equal, "rmse", {"pt", "bpt"});
  equal.factor = 1.5;
  const auto made = [](const std::vector<double>& bpt) {
    return MadeUp().with("pt", "rmse", {1.0, 1.01}).with("bpt", "rmse", bpt);
  };
  EXPECT_EQ(made({1.2, 1.21}).verdict(equal), kHolds);
  EXPECT_EQ(made({0.5, 0.501}).verdict(equal), kFails);
  EXPECT_EQ(made({1.5, 1.53}).verdict(equal), kUndecided);
}

TEST(JudgeClaims, reachesAndMisses) {
  Condition reaches = condition(ConditionKind::reaches, "ssim", {"pt"});
  Condition misses = condition(ConditionKind::misses, "ssim", {"pt"});
  reaches.score = misses.score = 0.9;
  const MadeUp above = MadeUp().with("pt", "ssim", {0.95, 0.951}), below = MadeUp().with("pt", "ssim", {0.5, 0.501}),
               near = MadeUp().with("pt", "ssim", {0.89, 0.91});
  EXPECT_EQ(above.verdict(reaches), kHolds);
  EXPECT_EQ(above.verdict(misses), kFails);
  EXPECT_EQ(below.verdict(reaches), kFails);
  EXPECT_EQ(below.verdict(misses), kHolds);
  EXPECT_EQ(near.verdict(reaches), kUndecided);
  EXPECT_EQ(near.verdict(misses), kUndecided);
  // A score that an image without error misses as well.
  const MadeUp noisy = MadeUp().with("pt", "ssim", {0.875, 0.875}).floor("ssim", 0.88);
  EXPECT_EQ(noisy.verdict(reaches), kNotJudged);
  EXPECT_EQ(noisy.judge(reaches).figure, "SSIM of pt is 0.875; the reference's noise alone gives 0.88");
  EXPECT_EQ(MadeUp(above).floor("ssim", 0.88).verdict(reaches), kHolds) << "it is reached all the same";
  EXPECT_EQ(MadeUp(below).floor("ssim", 0.95).verdict(reaches), kFails);
  EXPECT_EQ(MadeUp().with("pt", "ssim", {0.4, 0.4}).floor("ssim", 0.45).verdict(misses), kNotJudged);
  EXPECT_EQ(MadeUp(above).floor("ssim", 0.45).verdict(misses), kFails);
  // Runs without this metric, as of an image that is too small for it.
  const MadeUp other = MadeUp().with("pt", "rmse", {1, 1.1});
  EXPECT_EQ(other.verdict(reaches), kNotJudged);
  EXPECT_EQ(other.judge(reaches).figure, "SSIM of pt was not measured");
}

TEST(JudgeClaims, stalls) {
  Condition stalls{.kind = ConditionKind::stalls, .methods = {"pt"}, .than = {"vcm"}};
  stalls.slope = -0.25;
  const auto made = [](double pt, double vcm) {
    return MadeUp().slope("pt", {pt, pt + 0.01}).slope("vcm", {vcm, vcm + 0.01});
  };
  EXPECT_EQ(made(-0.02, -0.5).verdict(stalls), kHolds);
  EXPECT_EQ(made(-0.5, -0.5).verdict(stalls), kFails) << "a slope of -1/2 converges";
  EXPECT_EQ(MadeUp().slope("pt", {0, -0.5}).slope("vcm", {-0.5, -0.51}).verdict(stalls), kUndecided);
  EXPECT_EQ(MadeUp().slope("pt", {0}).slope("vcm", {-0.45}).verdict(stalls), kHolds) << "of one seed too";
  EXPECT_EQ(MadeUp().slope("pt", {0}).slope("vcm", {-0.3}).verdict(stalls), kUndecided) << "the control is open";
  const ClaimRecord both = made(-0.02, -0.022).judge(stalls);
  EXPECT_EQ(both.verdict, kNotJudged) << "the control stalls as well, so something else does it";
  EXPECT_EQ(both.figure, "the control, vcm, may stall as well: slope -0.02");
  const ClaimRecord without = MadeUp().slope("pt", {0}).errors("vcm", {0, 0, 0, 0, 0}, 1).judge(stalls);
  EXPECT_EQ(without.verdict, kNotJudged) << "the control has no error above 0";
  EXPECT_EQ(without.figure, "no error of the control, vcm, without the reference's noise was measured");
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1.1}).with("vcm", "rmse", {1, 1.1}).verdict(stalls), kNotJudged)
      << "RMSE has the reference's noise in it";
}

TEST(JudgeClaims, biased) {
  Condition biased = condition(ConditionKind::biased, "", {"ppm"});
  biased.share = 0.1;
  const auto made = [](const std::vector<double>& shares) {
    return MadeUp().with("ppm", "rmse", {1, 1.1}).bias("ppm", shares);
  };
  EXPECT_EQ(made({0.01, 0.3, 0.4, 0.5}).verdict(biased), kHolds) << "the last three count";
  EXPECT_EQ(made({0.9, 0.01, -0.01, 0.02}).verdict(biased), kFails);
  EXPECT_EQ(made({0.3, 0.01, 0.3}).verdict(biased), kUndecided);
  EXPECT_EQ(made({}).verdict(biased), kNotJudged);
  const ClaimRecord ofTwo = MadeUp().with("ppm", "rmse", {1, 1.1}).bias("ppm", {0.5, 0.5, 0.5}, 2).judge(biased);
  EXPECT_EQ(ofTwo.verdict, kUndecided);
  EXPECT_EQ(ofTwo.figure, "bias^2 of ppm is 50.0 % of its mean square error, limit 10 %, by 2 seeds");
  biased.methods = {"mlt"};
  const MadeUp both = MadeUp().with("mlt-pathspace", "rmse", {1, 1.1}).bias("mlt-pathspace", {0.5}).bias("mlt", {0});
  EXPECT_EQ(both.verdict(biased), kHolds) << "the study's mlt is that of path space";
}

// As in a campaign of the study's own protocol.
TEST(JudgeClaims, oneSeedDecidesWhatIsBeyondTheUsualSpreadOfSeeds) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {100}).verdict(better), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {100}).with("lt", "rmse", {1}).verdict(better), kFails);
  // Two seeds of pt are up to 0.112 apart in the logarithm of RMSE, those of lt 0.21: a band of 0.168.
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {1.16}).verdict(better), kUndecided);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {1.19}).verdict(better), kHolds);
  const Condition bySsim = condition(ConditionKind::better, "ssim", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "ssim", {0.9}).with("lt", "ssim", {0.8}).verdict(bySsim), kHolds);
}

// Two curves that end at the same distance: where both fall as 1 / t the times are told apart, where one is flat not.
TEST(JudgeClaims, ofOneSeedTimesAreAsUncertainAsTheLossOverTheSlope) {
  const Condition faster = condition(ConditionKind::faster, "rmse", {"vcm"}, {"pt"});
  EXPECT_EQ(MadeUp().curve("vcm", "rmse", {8, 4, 2, 1, 0.5}).curve("pt", "rmse", {12, 6, 3, 1.5, 0.75}).verdict(faster),
            kHolds);
  EXPECT_EQ(MadeUp()
                .curve("vcm", "rmse", {8, 4, 2, 1, 0.74})
                .curve("pt", "rmse", {0.77, 0.765, 0.76, 0.755, 0.75})
                .verdict(faster),
            kUndecided);
}

// By its slope pt, 1.56 times behind, is level with bpt after 1.6 times the runs.
TEST(JudgeClaims, whatWouldCatchUpInTheStudysTimeLacksTime) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"bpt"});
  const auto judged = [&](double share) {  // of the study's 8,789 paths per pixel
    const std::string stats = R"({"width": 10, "height": 10, "camera_paths": )" + std::to_string(878'906 * share) + "}";
    return MadeUp()
        .curve("pt", "rmse", {8, 4, 2, 1, 0.5})
        .curve("bpt", "rmse", {0.32, 0.32, 0.32, 0.32, 0.32})
        .stats(stats)
        .judge(better);
  };
  EXPECT_EQ(judged(0.1).verdict, kNotReached);
  EXPECT_EQ(judged(0.1).figure, "RMSE bpt 0.32, pt 0.5; at these rates level after 25 s");
  EXPECT_NE(judged(0.1).evidence.find("of the study's paths per pixel: bpt 0.1, pt 0.1"), std::string::npos)
      << judged(0.1).evidence;
  EXPECT_EQ(judged(0.7).verdict, kFails) << "not within the study's time";
  // Which is behind and falls no faster does not.
  const Condition opposite = condition(ConditionKind::better, "rmse", {"bpt"}, {"lt"});
  EXPECT_EQ(MadeUp()
                .curve("bpt", "rmse", {8, 4, 2, 1, 0.5})
                .curve("lt", "rmse", {4, 2, 1, 0.5, 0.25})
                .stats(R"({"width": 10, "height": 10, "camera_paths": 1000})")
                .verdict(opposite),
            kFails);
}

// pt has three times the error of bpt at all times. Against the noise of the reference bpt seems to stand still.
TEST(JudgeClaims, theReferencesNoiseLetsNothingCatchUp) {
  const MadeUp made =
      MadeUp().errors("pt", {12, 8.485, 6, 4.243, 3}, 1).errors("bpt", {4, 2.828, 2, 1.414, 1}, 1).floor("rmse", 1);
  const ClaimRecord byError =
      MadeUp(made).stats(kFewPaths).judge(condition(ConditionKind::better, "rmse", {"pt"}, {"bpt"}));
  EXPECT_EQ(byError.verdict, kFails);
  EXPECT_EQ(byError.figure, "RMSE bpt 1, pt 3");
  EXPECT_NE(byError.evidence.find("rmse: pt 3, bpt 1 (without the reference's noise)"), std::string::npos)
      << byError.evidence;
  // SSIM has the noise in it: losses are 0.01 + 0.12 / sqrt(t) and 0.01 + 0.036 / sqrt(t).
  const MadeUp bySsim = MadeUp()
                            .curve("pt", "ssim", {0.87, 0.9051, 0.93, 0.9476, 0.96})
                            .curve("bpt", "ssim", {0.954, 0.9645, 0.972, 0.9773, 0.981})
                            .stats(kFewPaths);
  const Condition better = condition(ConditionKind::better, "ssim", {"pt"}, {"bpt"});
  EXPECT_EQ(MadeUp(bySsim).floor("ssim", 0.99).verdict(better), kFails);
  EXPECT_EQ(bySsim.verdict(better), kNotReached) << "noise that is not known";
}

TEST(JudgeClaims, withoutAnErrorOfEachRunRmseIsThatOfTheImages) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"bpt"});
  const MadeUp made = MadeUp().errors("pt", {2, 1}, 3).errors("bpt", {1, 0}, 3);
  EXPECT_EQ(made.judge(better).figure, "RMSE bpt 3, pt 3.16");
}

// Direct light of ppm from photons, or by next event estimation.
TEST(JudgeClaims, ofPpmBothReadingsDecide) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"ppm"});
  const auto made = [](const std::vector<double>& photons, const std::vector<double>& direct) {
    return MadeUp().with("pt", "rmse", {1, 1.01}).with("ppm", "rmse", photons).with("ppm-direct", "rmse", direct);
  };
  EXPECT_EQ(made({2, 2.01}, {3, 3.01}).verdict(better), kHolds);
  EXPECT_EQ(made({0.2, 0.201}, {0.3, 0.301}).verdict(better), kFails);
  const ClaimRecord differ = made({2, 2.01}, {0.5, 0.501}).judge(better);
  EXPECT_EQ(differ.verdict, kUndecided);
  EXPECT_EQ(differ.figure, "by ppm: holds, RMSE ppm 2, pt 1; by ppm-direct: does not hold, RMSE ppm-direct 0.5, pt 1");
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1.01}).with("ppm", "rmse", {2, 2.01}).verdict(better), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1.01}).with("ppm-direct", "rmse", {2, 2.01}).verdict(better), kHolds);
  // One that has no RMSE.
  for (const double ppm : {0.2, 2.0}) {
    const MadeUp one = MadeUp().with("pt", "rmse", {1, 1.01}).with("ppm", "rmse", {ppm, 1.01 * ppm});
    EXPECT_EQ(MadeUp(one).with("ppm-direct", "ssim", {0.5, 0.51}).verdict(better), kNotJudged) << ppm;
  }
}

TEST(JudgeClaims, generalClaimsCountScenes) {
  Claim claim{.id = "c",
              .scene = "general",
              .statement = "so",
              .conditions = {condition(ConditionKind::better, "rmse", {"pt"}, {"lt"})},
              .scenes = {"s", "box", "room"},
              .atLeast = 2};
  const MadeUp one = MadeUp().with("pt", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01}).scene("box");
  const auto made = [&](double pt) {
    return MadeUp(one).with("pt", "rmse", {pt, 1.01 * pt}).with("lt", "rmse", {2, 2.01});
  };
  EXPECT_EQ(judgeClaim(claim, made(1).results()).verdict, kHolds);
  EXPECT_EQ(judgeClaim(claim, made(4).results()).verdict, kNotJudged) << "the third scene may still hold";
  EXPECT_EQ(judgeClaim(claim, one.results()).verdict, kNotJudged);
  claim.atLeast = 3;
  EXPECT_EQ(judgeClaim(claim, made(4).results()).verdict, kFails) << "two of three is all there can be";
}

TEST(JudgeClaims, evidenceGivesValuesAndBands) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  const std::string evidence =
      MadeUp().with("pt", "rmse", {2, 2.01}).with("lt", "rmse", {1, 1.01}).floor("rmse", 0.5).judge(better).evidence;
  EXPECT_NE(evidence.find("rmse: pt 2.005 ± 0.064, lt 1.005 ± 0.064 (noise floor 0.5)"), std::string::npos) << evidence;
}

TEST(JudgeClaims, theFigureIsTheComparisonThatDecides) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt", "bpt"});
  const auto figure = [&](double lt) {
    return MadeUp()
        .with("pt", "rmse", {2, 2.01})
        .with("lt", "rmse", {lt, 1.01 * lt})
        .with("bpt", "rmse", {4, 4.01})
        .judge(better)
        .figure;
  };
  EXPECT_EQ(figure(1), "RMSE lt 1, pt 2") << "the one that refutes";
  EXPECT_EQ(figure(3), "RMSE lt 3.02, pt 2") << "the closest";
}

}  // namespace
}  // namespace wavecrest
