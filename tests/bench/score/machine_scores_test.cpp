// Scores of several machines: reading their JSON, which of them are comparable, and their order in the table.
#include "bench/score/machine_scores.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "bench/score/expected.h"

namespace wavecrest {
namespace {

using Json = nlohmann::json;

// A score with every entry of the size's workload.
Json scoreFile(const std::string& cpu, double score, ScoreSize size = ScoreSize::small) {
  Json entries = Json::array();
  for (const ScoreEntry& entry : workloadOf(size)) {
    entries.push_back({{"scene", entry.scene},
                       {"method", std::string(toString(entry.method))},
                       {"paths_per_second", 1e4 * score},
                       {"image", "exact"},
                       {"image_verdict", "exact"}});
  }
  return {{"kind", "score"},
          {"version", "0.1.0"},
          {"commit", "0123456789ab"},
          {"machine", {{"cpu", cpu}}},
          {"score_version", kScoreVersion},
          {"size", std::string(kScoreSizeNames[static_cast<size_t>(size)])},
          {"isa", "avx2"},
          {"threads", 8},
          {"compiler", "GCC 12.2.0"},
          {"valid", true},
          {"score", score},
          {"core_score", score / 8},
          {"method_scores", {{"pt", score}, {"vcm", 2 * score}}},
          {"entries", entries},
          {"doubts", Json::array()}};
}

TEST(MachineScores, haveWhatTheFileSays) {
  Json file = scoreFile("A processor", 640);
  file["entries"][0]["image"] = "within tolerance";
  file["doubts"] = {"a busy machine"};
  const MachineScore score = readMachineScore(file);
  EXPECT_EQ(score.machine, "A processor");
  EXPECT_EQ(score.build, "0.1.0 0123456789ab, GCC 12.2.0");
  EXPECT_EQ(score.threads, 8u);
  EXPECT_EQ(score.score, 640);
  EXPECT_EQ(score.coreScore, 80);
  EXPECT_EQ(score.tolerated, 1u);
  EXPECT_EQ(score.entries, workloadOf(ScoreSize::small).size());
  EXPECT_TRUE(score.whole);
  EXPECT_EQ(score.refusal, "");
  EXPECT_EQ(score.methods.at("vcm"), 1280);
  EXPECT_EQ(score.rates.size(), score.entries);
  EXPECT_EQ(score.rates.at("cornell-diffuse, pt"), 6.4e6);
  EXPECT_EQ(score.doubts, std::vector<std::string>{"a busy machine"});
}

TEST(MachineScores, ofOtherKindsAreTold) {
  EXPECT_TRUE(isScore(scoreFile("A", 1)));
  EXPECT_FALSE(isScore(Json{{"kind", "throughput"}}));
  EXPECT_FALSE(isScore(Json::array()));
  EXPECT_FALSE(isScore(Json::object()));
}

TEST(MachineScores, thatAreDamagedAreRefused) {
  const auto refused = [](auto&& damage) {
    Json file = scoreFile("A", 100);
    damage(file);
    EXPECT_THROW(readMachineScore(file), ScoreFileError) << file.dump().substr(0, 200);
  };
  refused([](Json& file) { file["score_version"] = kScoreVersion + 1; });
  refused([](Json& file) { file["size"] = "huge"; });
  refused([](Json& file) { file["score"] = 0; });
  refused([](Json& file) { file["core_score"] = "fast"; });
  refused([](Json& file) { file["method_scores"]["pt"] = -1; });
  refused([](Json& file) { file["entries"][0]["paths_per_second"] = 0; });
  for (const char* key : {"machine", "version", "commit", "compiler", "isa", "threads", "entries", "doubts"}) {
    refused([key](Json& file) { file.erase(key); });
  }
}

TEST(MachineScores, areSortedBySizeAndThenByTheScoreOfThoseThatCount) {
  Json part = scoreFile("part", 900), wrong = scoreFile("wrong", 1000);
  part["entries"].erase(0);
  wrong["entries"][2]["image"] = "refused";
  wrong["entries"][2]["image_verdict"] = "refused (another hash)";
  std::vector<MachineScore> scores;
  for (const Json& file :
       {scoreFile("large", 5000, ScoreSize::large), wrong, part, scoreFile("slow", 10), scoreFile("fast", 20)}) {
    scores.push_back(readMachineScore(file));
  }
  sortScores(scores);
  std::vector<std::string> order;
  order.reserve(scores.size());
  for (const MachineScore& score : scores) order.push_back(score.machine);
  EXPECT_EQ(order, (std::vector<std::string>{"fast", "slow", "part", "wrong", "large"}));
  // Neither a part of the workload nor a wrong image has a figure.
  const std::string text = machinesText(scores);
  EXPECT_EQ(text.find("900"), std::string::npos) << text;
  EXPECT_EQ(text.find("1000"), std::string::npos) << text;
  EXPECT_NE(text.find("refused (another hash)"), std::string::npos) << text;
  EXPECT_NE(text.find("5000"), std::string::npos) << text;
}

TEST(MachineScores, haveRatesInThePageIfTheyCount) {
  Json wrong = scoreFile("wrong", 300);
  wrong["entries"][0]["image"] = "refused";
  wrong["doubts"] = {"a busy machine"};
  const MachineScore fast = readMachineScore(scoreFile("fast", 200)), refusal = readMachineScore(wrong);
  const std::string page = machinesPage({fast, refusal});
  EXPECT_NE(page.find("<td class=\"n\">200<td class=\"n\">25<td class=\"n\">25<td>avx2"), std::string::npos) << page;
  EXPECT_NE(page.find("<th class=\"n\">fast, 8 threads</thead>"), std::string::npos) << page;
  EXPECT_NE(page.find("<tr><th>cornell-diffuse, pt<td class=\"n\">2 M<tr>"), std::string::npos) << page;
  EXPECT_EQ(page.find("3 M"), std::string::npos) << page;
  EXPECT_NE(page.find("doubt: a busy machine"), std::string::npos) << page;
  EXPECT_EQ(machinesPage({refusal}).find("Paths per second"), std::string::npos);
  Json denied = scoreFile("denied", 400);
  denied["valid"] = false;
  EXPECT_EQ(readMachineScore(denied).refusal, "not valid");
}

TEST(MachineScores, areEscapedInThePage) {
  const std::string page = machinesPage({readMachineScore(scoreFile("<b>&", 7))});
  EXPECT_NE(page.find("&lt;b&gt;&amp;"), std::string::npos);
  EXPECT_EQ(page.find("<b>&"), std::string::npos);
}

}  // namespace
}  // namespace wavecrest
