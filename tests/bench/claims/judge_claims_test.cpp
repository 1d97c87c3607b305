// Every kind of condition on made-up results: once where it holds, once where it does not, once where noise decides.
#include "bench/claims/judge_claims.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wavecrest {
namespace {

// Results of one scene "s"; each method has a run per final score, with an RMSE that falls from twice that value at a
// quarter of the time (a slope of -1/2) unless given otherwise.
class MadeUp {
 public:
  MadeUp() { results_.scenes.push_back({.name = "s", .hash = "0", .referenceFile = ""}); }
  MadeUp& with(const std::string& method, const std::string& metric, const std::vector<double>& finalScores,
               double before = 2) {
    for (size_t i = 0; i < finalScores.size(); ++i) {
      results_.runs.push_back(
          {.scene = "s",
           .method = method,
           .seed = i + 1,
           .snapshots = {
               {.number = 0,
                .renderSeconds = 1,
                .iterations = 1,
                .file = "",
                .values = {{metric, before * finalScores[i]}}},
               {.number = 1, .renderSeconds = 4, .iterations = 4, .file = "", .values = {{metric, finalScores[i]}}}}});
    }
    return *this;
  }
  MadeUp& floor(const std::string& metric, double value) {
    results_.scenes[0].noiseFloors[metric] = value;
    return *this;
  }
  MadeUp& refuse(const std::string& method) {
    results_.runs.push_back(
        {.scene = "s", .method = method, .seed = 1, .state = RunState::refused, .reason = "it cannot"});
    return *this;
  }
  MadeUp& bias(const std::string& method, const std::vector<double>& shares) {
    for (unsigned i = 0; i < shares.size(); ++i) {
      results_.biases.push_back({"s", method, i, 2, 1.0, 1 - shares[i], shares[i]});
    }
    return *this;
  }
  ClaimRecord judge(const Condition& condition) const {
    return judgeClaim({.id = "c", .scene = "s", .statement = "so", .conditions = {condition}}, results_);
  }
  std::string verdict(const Condition& condition) const { return judge(condition).verdict; }
  const CampaignResults& results() const { return results_; }

 private:
  CampaignResults results_;
};

Condition condition(ConditionKind kind, const std::string& metric, const std::vector<std::string>& methods,
                    const std::vector<std::string>& than = {}) {
  return {.kind = kind, .metrics = {metric}, .methods = methods, .than = than};
}

const std::string kHolds = "holds", kFails = "does not hold", kUndecided = "undecided";

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
  EXPECT_EQ(made({2.5, 2.51}).verdict(poor), kHolds) << "beyond the factor of one of them is enough";
  EXPECT_EQ(made({2.0, 2.02}).verdict(good), kUndecided);
  EXPECT_EQ(made({2.0, 2.02}).verdict(poor), kUndecided);
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
}

TEST(JudgeClaims, stalls) {
  Condition stalls = condition(ConditionKind::stalls, "rmse", {"pt"});
  stalls.slope = -0.25;
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1.1}, 1.02).verdict(stalls), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1.1}, 2).verdict(stalls), kFails) << "a slope of -1/2 converges";
  // Slopes of 0 and -1/2.
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}, 1).with("pt", "rmse", {1}, 2).verdict(stalls), kUndecided);
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
  EXPECT_EQ(made({}).verdict(biased), kUndecided);
}

TEST(JudgeClaims, oneSeedDecidesNothing) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {100}).verdict(better), kUndecided);
}

TEST(JudgeClaims, whatWasNotMeasuredIsUndecidedAndSaid) {
  const Condition better = condition(ConditionKind::better, "rmse", {"mlt", "pt"}, {"lt"});
  const MadeUp made = MadeUp().with("pt", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01});
  const ClaimRecord absent = made.judge(better), refused = MadeUp(made).refuse("mlt").judge(better);
  EXPECT_EQ(absent.verdict, kUndecided);
  EXPECT_NE(absent.evidence.find("mlt was not measured"), std::string::npos) << absent.evidence;
  EXPECT_EQ(refused.verdict, kUndecided);
  EXPECT_NE(refused.evidence.find("mlt was refused"), std::string::npos) << refused.evidence;
  const Condition wrongToo = condition(ConditionKind::better, "rmse", {"mlt", "lt"}, {"pt"});
  EXPECT_EQ(made.verdict(wrongToo), kFails) << "what was measured is enough to refute";
}

TEST(JudgeClaims, differencesBelowTheReferencesNoiseAreUndecided) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  const MadeUp made = MadeUp().with("pt", "rmse", {1.2, 1.201}).with("lt", "rmse", {1.1, 1.101});
  EXPECT_EQ(made.verdict(better), kFails);
  EXPECT_EQ(MadeUp(made).floor("rmse", 1.0).verdict(better), kUndecided) << "both are mostly the reference's noise";
  EXPECT_EQ(MadeUp(made).floor("rmse", 0.1).verdict(better), kFails);
}

TEST(JudgeClaims, evidenceGivesValuesAndBands) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  const std::string evidence =
      MadeUp().with("pt", "rmse", {2, 2.01}).with("lt", "rmse", {1, 1.01}).floor("rmse", 0.5).judge(better).evidence;
  EXPECT_NE(evidence.find("rmse: pt 2.005 ± 0.064, lt 1.005 ± 0.064 (noise floor 0.5)"), std::string::npos) << evidence;
  EXPECT_NE(evidence.find("not so: pt against lt in rmse"), std::string::npos) << evidence;
}

TEST(JudgeClaims, evidenceNamesWhoIsNotAheadOfWhomOnce) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt", "bpt"});
  const std::string evidence = MadeUp()
                                   .with("pt", "rmse", {2, 2.01})
                                   .with("lt", "rmse", {1, 1.01})
                                   .with("bpt", "rmse", {1, 1.01})
                                   .judge(better)
                                   .evidence;
  EXPECT_TRUE(evidence.ends_with("; not so: pt against lt, bpt in rmse")) << evidence;
}

TEST(StudyClaims, nameScenesMethodsAndMetricsThatExist) {
  const std::vector<std::string> methods{"pt", "lt", "bpt", "mlt", "ppm", "vcm"}, metrics{"rmse", "ssim", "q_mos"};
  const auto known = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  std::map<std::string, int> scenes;
  for (const Claim& claim : studyClaims()) {
    ++scenes[claim.scene];
    EXPECT_TRUE(claim.id.starts_with(claim.scene + ".")) << claim.id;
    EXPECT_FALSE(claim.source.empty()) << claim.id;
    EXPECT_EQ(findStudyClaim(claim.id), &claim);
    for (const Condition& c : claim.conditions) {
      EXPECT_FALSE(c.methods.empty()) << claim.id;
      for (const std::string& name : c.methods) EXPECT_TRUE(known(methods, name)) << claim.id << name;
      for (const std::string& name : c.than) EXPECT_TRUE(known(methods, name)) << claim.id << name;
      for (const std::string& name : c.metrics) EXPECT_TRUE(known(metrics, name)) << claim.id << name;
    }
  }
  EXPECT_EQ(scenes.size(), 9u);
  EXPECT_EQ(findStudyClaim("nothing"), nullptr);
}

TEST(StudyClaims, malformedListsAreRefused) {
  EXPECT_THROW(parseClaims("{"), ClaimListError);
  EXPECT_THROW(parseClaims(R"([{"id": "a"}])"), ClaimListError);
  const std::string head = R"([{"id": "a", "scene": "s", "statement": "t", "all": [)";
  EXPECT_THROW(parseClaims(head + "]}]"), ClaimListError);
  const std::string condition = R"({"kind": "good", "metrics": [], "methods": []})";
  EXPECT_THROW(parseClaims(head + condition + R"(], "explanatoin": "so"}])"), ClaimListError);
  EXPECT_EQ(parseClaims(head + condition + R"(], "explanation": "so"}])").at(0).explanation, "so");
  EXPECT_THROW(parseClaims(head + R"({"kind": "nice", "metrics": [], "methods": []}]}])"), ClaimListError);
  EXPECT_THROW(parseClaims(head + R"({"kind": "good", "metrics": [], "methods": [], "facter": 2}]}])"), ClaimListError);
  EXPECT_EQ(parseClaims(head + R"({"kind": "good", "metrics": [], "methods": [], "factor": 2}]}])").size(), 1u);
}

TEST(StudyClaims, areJudgedForTheScenesOfATimedCampaignOnly) {
  CampaignResults results;
  results.scenes.push_back({.name = "cornell-glossy", .hash = "0", .referenceFile = ""});
  EXPECT_EQ(judgeStudyClaims(results).size(), 3u);
  results.campaign["spp"] = "4";
  EXPECT_TRUE(judgeStudyClaims(results).empty());
}

}  // namespace
}  // namespace wavecrest
