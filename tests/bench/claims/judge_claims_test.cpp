// Every kind of condition on made-up results: once where it holds, once where it does not, once where noise decides.
#include "bench/claims/judge_claims.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/claims/explanations.h"

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
  // Errors without the reference's noise, whose root goes as time to this power, at five times.
  MadeUp& slope(const std::string& method, const std::vector<double>& powers) {
    for (size_t i = 0; i < powers.size(); ++i) {
      RunRecord run{.scene = "s", .method = method, .seed = i + 1};
      for (unsigned k = 0; k < 5; ++k) {
        const double time = std::pow(2.0, k);
        run.snapshots.push_back({.number = k,
                                 .renderSeconds = time,
                                 .iterations = k,
                                 .file = "",
                                 .values = {{kUnbiasedMse, std::pow(time, 2 * powers[i])}}});
      }
      results_.runs.push_back(run);
    }
    return *this;
  }
  // The stats of every run.
  MadeUp& stats(const std::string& json) {
    for (RunRecord& run : results_.runs) run.stats = json;
    return *this;
  }
  MadeUp& scene(const std::string& name) {
    results_.scenes.push_back({.name = name, .hash = "0", .referenceFile = ""});
    for (RunRecord& run : results_.runs) run.scene = run.scene == "s" ? name : run.scene;
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

const std::string kHolds = "holds", kFails = "does not hold", kUndecided = "undecided", kNotJudged = "not judged";

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
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1, 1}, 1).with("lt", "rmse", {1, 1}, 1).verdict(faster), kUndecided);
  // Ahead at the end by little, but only after a start far behind: no sooner at the quality that both reach.
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1.0, 1.3}, 9).with("lt", "rmse", {1.1, 1.2}, 1.5).verdict(faster), kUndecided);
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
  const ClaimRecord both = made(-0.02, -0.02).judge(stalls);
  EXPECT_EQ(both.verdict, kNotJudged) << "the control stalls as well, so something else does it";
  EXPECT_EQ(both.figure, "the control, vcm, may stall as well: slope -0.02");
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
  biased.methods = {"mlt"};
  const MadeUp both = MadeUp().with("mlt-pathspace", "rmse", {1, 1.1}).bias("mlt-pathspace", {0.5}).bias("mlt", {0});
  EXPECT_EQ(both.verdict(biased), kHolds) << "the study's mlt is that of path space";
}

// As in a campaign of the study's own protocol.
TEST(JudgeClaims, oneSeedDecidesWhatIsBeyondTheUsualSpreadOfSeeds) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {100}).verdict(better), kHolds);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {100}).with("lt", "rmse", {1}).verdict(better), kFails);
  EXPECT_EQ(MadeUp().with("pt", "rmse", {1}).with("lt", "rmse", {2}).verdict(better), kUndecided);
  const Condition bySsim = condition(ConditionKind::better, "ssim", {"pt"}, {"lt"});
  EXPECT_EQ(MadeUp().with("pt", "ssim", {0.9}).with("lt", "ssim", {0.8}).verdict(bySsim), kHolds);
}

TEST(JudgeClaims, whatWasNotMeasuredIsNotJudgedAndSaid) {
  const Condition better = condition(ConditionKind::better, "rmse", {"mlt", "pt"}, {"lt"});
  const MadeUp made =
      MadeUp().with("pt", "rmse", {1, 1.01}).with("lt", "rmse", {2, 2.01}).with("mlt", "rmse", {1, 1.01});
  const ClaimRecord absent = made.judge(better), refused = MadeUp(made).refuse("mlt-pathspace").judge(better);
  EXPECT_EQ(absent.verdict, kNotJudged) << "the study's mlt is that of path space";
  EXPECT_EQ(absent.figure, "mlt-pathspace was not measured");
  EXPECT_EQ(refused.verdict, kNotJudged);
  EXPECT_EQ(refused.figure, "mlt-pathspace was refused");
  EXPECT_EQ(MadeUp(made).with("mlt-pathspace", "rmse", {1, 1.01}).verdict(better), kHolds);
  const Condition wrongToo = condition(ConditionKind::better, "rmse", {"mlt", "lt"}, {"pt"});
  EXPECT_EQ(made.verdict(wrongToo), kFails) << "what was measured is enough to refute";
}

TEST(JudgeClaims, differencesBelowTheReferencesNoiseAreNotJudged) {
  const Condition better = condition(ConditionKind::better, "rmse", {"pt"}, {"lt"});
  const MadeUp made = MadeUp().with("pt", "rmse", {1.2, 1.201}).with("lt", "rmse", {1.1, 1.101});
  EXPECT_EQ(made.verdict(better), kFails);
  EXPECT_EQ(MadeUp(made).floor("rmse", 1.0).verdict(better), kNotJudged) << "both are mostly the reference's noise";
  EXPECT_EQ(MadeUp(made).floor("rmse", 0.1).verdict(better), kFails);
}

// 0.02 of the study's light paths in a search, and a twelfth of its paths per pixel.
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
  EXPECT_EQ(judgeClaim(claim, made.results()).figure, "lt made 0.084 of the study's paths per pixel; needs 0.1");
  claim.needs = {.lightPaths = 0.3};
  const char* const wide = R"({"iterations": 100, "light_paths": 1572864, "radius": 0.004})";
  EXPECT_EQ(judgeClaim(claim, MadeUp(made).stats(wide).results()).verdict, kHolds) << "16 times the area of search";
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

TEST(StudyClaims, nameScenesMethodsAndMetricsThatExist) {
  const std::vector<std::string> methods{"pt", "lt", "bpt", "mlt", "ppm", "vcm"}, metrics{"rmse", "ssim", "q_mos"};
  const auto known = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  std::map<std::string, int> scenes;
  for (const Claim& claim : studyClaims()) {
    if (!claim.isGeneral()) ++scenes[claim.scene];
    EXPECT_TRUE(claim.id.starts_with(claim.scene + ".")) << claim.id;
    EXPECT_LE(claim.atLeast, claim.scenes.size()) << claim.id;
    EXPECT_GT(claim.needs.paths, 0) << claim.id;
    EXPECT_FALSE(claim.source.empty()) << claim.id;
    EXPECT_EQ(findStudyClaim(claim.id), &claim);
    for (const Condition& c : claim.conditions) {
      EXPECT_FALSE(c.methods.empty()) << claim.id;
      const bool merges =
          known(c.methods, "ppm") || known(c.methods, "vcm") || known(c.than, "ppm") || known(c.than, "vcm");
      const bool asControl = c.kind == ConditionKind::stalls;  // that converges at all, with however few photons
      EXPECT_EQ(claim.needs.lightPaths > 0 || !merges || asControl, true) << claim.id << " is about photons";
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
  EXPECT_THROW(parseClaims(head + condition + R"(], "suorce": "so"}])"), ClaimListError);
  EXPECT_EQ(parseClaims(head + condition + R"(], "source": "so"}])").at(0).source, "so");
  EXPECT_THROW(parseClaims(head + R"({"kind": "nice", "metrics": [], "methods": []}]}])"), ClaimListError);
  EXPECT_THROW(parseClaims(head + R"({"kind": "good", "metrics": [], "methods": [], "facter": 2}]}])"), ClaimListError);
  EXPECT_EQ(parseClaims(head + R"({"kind": "good", "metrics": [], "methods": [], "factor": 2}]}])").size(), 1u);
}

TEST(StudyClaims, areJudgedForTheScenesOfATimedCampaignOnly) {
  CampaignResults results;
  results.scenes.push_back({.name = "cornell-glossy", .hash = "0", .referenceFile = ""});
  const std::vector<ClaimRecord> records = judgeStudyClaims(results);
  EXPECT_EQ(records.size(), 5u) << "three of the scene, two about all nine";
  for (const ClaimRecord& record : records) EXPECT_EQ(record.verdict, kNotJudged) << record.id;
  results.campaign["spp"] = "4";
  EXPECT_TRUE(judgeStudyClaims(results).empty());
}

TEST(Explanations, areOfKnownClaimsAndOneOfEachInAProfile) {
  const std::string entry = R"({"claims": ["pool-interior.pt-fails"], "text": "so"})";
  const auto explanations = parseExplanations(R"({"quick": [)" + entry + R"(], "study": [)" + entry + "]}");
  ASSERT_EQ(explanations.size(), 2u);
  EXPECT_EQ(explanations[1].profile, "study");
  EXPECT_EQ(explanations[1].text, "so");
  EXPECT_THROW(parseExplanations(R"({"study": [)" + entry + "," + entry + "]}"), ClaimListError);
  EXPECT_THROW(parseExplanations(R"({"study": [{"claims": ["nothing"], "text": "so"}]})"), ClaimListError);
  EXPECT_THROW(parseExplanations(R"({"study": [{"claims": [], "text": "so"}]})"), ClaimListError);
  EXPECT_THROW(parseExplanations(R"({"study": [{"claims": ["pool-interior.pt-fails"]}]})"), ClaimListError);
  EXPECT_THROW(parseExplanations("["), ClaimListError);
}

TEST(Explanations, areOfTheProfileWhereItHasOne) {
  const Explanation* standard = findExplanation("dragon-caustics.pt-stalls", "standard");
  ASSERT_NE(standard, nullptr);
  EXPECT_EQ(standard->profile, "standard");
  EXPECT_NE(findExplanation("dragon-caustics.pt-stalls", "quick"), nullptr);
  EXPECT_EQ(findExplanation("nothing", "standard"), nullptr);
}

}  // namespace
}  // namespace wavecrest
