// The study's findings and their explanations as data: of scenes, methods and metrics that exist, in the form that is
// read.
#include "bench/claims/claim_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "bench/claims/explanations.h"
#include "bench/claims/judge_claims.h"

namespace wavecrest {
namespace {

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

// bench/claims/README.md says why. The rate at which methods converge is judged by losses that are equal.
TEST(StudyClaims, needPathsByWhatTheyAreAbout) {
  using K = ConditionKind;
  for (const Claim& claim : studyClaims()) {
    bool converging = false, comparesMlt = false;
    for (const Condition& c : claim.conditions) {
      if (c.kind == K::reaches || c.kind == K::misses || c.kind == K::stalls || c.kind == K::biased) converging = true;
      if (std::ranges::count(c.methods, "mlt") + std::ranges::count(c.than, "mlt") > 0) comparesMlt = true;
    }
    EXPECT_EQ(claim.needs.paths, converging ? 0.1 : comparesMlt ? 0.05 : 0.01) << claim.id;
  }
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
  EXPECT_EQ(records.size(), 6u) << "four of the scene, two about all nine";
  for (const ClaimRecord& record : records) EXPECT_EQ(record.verdict, "not judged") << record.id;
  results.campaign["spp"] = "4";
  EXPECT_TRUE(judgeStudyClaims(results).empty());
}

TEST(Explanations, areOfKnownClaimsAndOneOfEachInAProfile) {
  const std::string entry = R"({"claims": ["pool-interior.pt-fails"], "verdict": "undecided", "text": "so"})";
  const auto ofStudy = [](const std::string& entries) {
    return R"("study": {"commit": "c", "findings": [)" + entries + "]}";
  };
  const auto explanations =
      parseExplanations(R"({"quick": {"commit": "b", "findings": [)" + entry + "]}," + ofStudy(entry) + "}");
  ASSERT_EQ(explanations.size(), 2u);
  EXPECT_EQ(explanations[1].profile, "study");
  EXPECT_TRUE(isOf(explanations[1], "study", "c"));
  EXPECT_TRUE(isOf(explanations[1], "study", "a, c")) << "it went on by another program";
  EXPECT_FALSE(isOf(explanations[1], "study", "b"));
  EXPECT_FALSE(isOf(explanations[1], "study", "cc, b"));
  EXPECT_FALSE(isOf(explanations[1], "quick", "c"));
  EXPECT_EQ(explanations[1].verdict, "undecided");
  EXPECT_EQ(explanations[1].text, "so");
  for (const std::string& entries : {
           entry + "," + entry,
           std::string(R"({"claims": ["nothing"], "verdict": "undecided", "text": "so"})"),
           std::string(R"({"claims": [], "verdict": "undecided", "text": "so"})"),
           std::string(R"({"claims": ["pool-interior.pt-fails"], "verdict": "undecided"})"),
           std::string(R"({"claims": ["pool-interior.pt-fails"], "text": "so"})"),
       }) {
    EXPECT_THROW(parseExplanations("{" + ofStudy(entries) + "}"), ClaimListError) << entries;
  }
  EXPECT_THROW(parseExplanations(R"({"study": {"findings": []}})"), ClaimListError) << "of no campaign";
  EXPECT_THROW(parseExplanations("["), ClaimListError);
}

TEST(Explanations, areOfTheProfileWhereItHasOne) {
  const Explanation* standard = findExplanation("cornell-mirror.pt-loses-lead", "does not hold", "standard");
  ASSERT_NE(standard, nullptr);
  EXPECT_EQ(standard->profile, "standard");
  EXPECT_NE(findExplanation("cornell-mirror.pt-loses-lead", "does not hold", "quick"), nullptr);
  EXPECT_EQ(findExplanation("cornell-mirror.pt-loses-lead", "not reached in this time", "standard"), nullptr);
  EXPECT_EQ(findExplanation("nothing", "does not hold", "standard"), nullptr);
}

}  // namespace
}  // namespace wavecrest
