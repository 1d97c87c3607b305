// Stored results are compared row by row, and only if they are of one machine.
#include "bench/against/stored.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace wavecrest {
namespace {

using Json = nlohmann::json;

// A result with two methods in one scene; a slice takes about `seconds` for a million paths. drift: called once for
// each visit; returns the factor by which all its times are multiplied.
Json resultOf(double seconds, const std::function<double()>& drift = {}) {
  Json methods = Json::array();
  for (const char* method : {"pt", "vcm"}) {
    Json slices = Json::array();
    for (int visit = 0; visit < 6; ++visit) {
      const double secondsOfVisit = drift ? seconds * drift() : seconds;
      for (int i = 5 * visit; i < 5 * visit + 5; ++i) {
        slices.push_back(
            {{"visit", visit}, {"paths", 1000000}, {"cpu_seconds", secondsOfVisit * (1 + 0.001 * (i * 7 % 15))}});
      }
    }
    methods.push_back(
        {{"method", method},
         {"scaling", {{{"threads", 1}, {"slices", slices}}, {{"threads", 2}, {"slices", Json::array()}}}}});
  }
  return {{"machine", {{"cpu", "a CPU"}, {"cores", 2}}},
          {"scenes", {{{"scene", "box"}, {"width", 4}, {"height", 3}, {"methods", methods}}}}};
}

TEST(Stored, aSlowerResultIsCalledSoInEveryRow) {
  const StoredComparison result = compareStored(resultOf(1), resultOf(1.1), {});
  ASSERT_EQ(result.rows.size(), 2u);
  for (const StoredRow& row : result.rows) {
    EXPECT_EQ(row.scene, "box");
    EXPECT_EQ(row.size, "4x3");
    EXPECT_EQ(row.comparison.verdict, SpeedVerdict::slower);
    EXPECT_NEAR(row.comparison.speedup, 1 / 1.1, 0.01);
  }
  EXPECT_TRUE(result.anySlower());
  EXPECT_EQ(result.rows[1].method, "vcm");
}

TEST(Stored, namesOfScenesMayHaveBlanks) {
  Json result = resultOf(1);
  result["scenes"][0]["scene"] = "my own box";
  const StoredRow row = compareStored(result, result, {}).rows.front();
  EXPECT_EQ(row.scene, "my own box");
  EXPECT_EQ(row.method, "pt");
  EXPECT_EQ(row.size, "4x3");
}

TEST(Stored, equalResultsGetNoVerdict) {
  EXPECT_FALSE(compareStored(resultOf(1), resultOf(1), {}).anySlower());
  EXPECT_EQ(compareStored(resultOf(1.1), resultOf(1), {}).rows[0].comparison.verdict, SpeedVerdict::faster);
}

// All slices of a visit are slow where the machine is.
TEST(Stored, aSpeedThatDriftsBetweenVisitsGivesVerdictsAsOftenAsStated) {
  constexpr int kPairs = 60;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(1, 0.02);
  const auto drift = [&] { return noise(random); };
  int alarms = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const StoredComparison result = compareStored(resultOf(1, drift), resultOf(1, drift), {});
    const auto differs = [](const StoredRow& row) { return row.comparison.verdict != SpeedVerdict::noDifference; };
    alarms += std::any_of(result.rows.begin(), result.rows.end(), differs) ? 1 : 0;
  }
  EXPECT_LE(alarms, 11);  // 3 expected, five standard deviations of 1.7
}

TEST(Stored, whatOnlyOneHasIsListed) {
  Json after = resultOf(1);
  after["scenes"][0]["methods"].erase(1);
  const StoredComparison result = compareStored(resultOf(1), after, {});
  EXPECT_EQ(result.unmatched, std::vector<std::string>{"box vcm 4x3"});
}

// Of six visits each the least probability is 2 / 924: times 24 rows it is above 0.05.
TEST(Stored, rowsTooManyForAnyVerdictAreSaidToBe) {
  const auto withScenes = [](size_t count, double seconds) {
    Json result = resultOf(seconds);
    const Json scene = result["scenes"][0];
    result["scenes"] = Json::array();
    for (size_t i = 0; i < count; ++i) {
      result["scenes"].push_back(scene);
      result["scenes"].back()["scene"] = "box " + std::to_string(i);
    }
    return result;
  };
  for (const size_t scenes : {11u, 12u}) {  // of two rows each
    const StoredComparison result = compareStored(withScenes(scenes, 1), withScenes(scenes, 2), {});
    EXPECT_NEAR(result.leastProbability, 2 * static_cast<double>(scenes) * 2 / 924, 1e-9);
    EXPECT_EQ(result.anySlower(), scenes == 11);
    EXPECT_EQ(toText(result).find("No verdict is possible") == std::string::npos, scenes == 11);
    EXPECT_EQ(toJson(result)["least_probability"], result.leastProbability);
  }
}

TEST(Stored, scenesThatShareANameAreRefused) {
  Json twice = resultOf(1);
  twice["scenes"].push_back(twice["scenes"][0]);
  EXPECT_THROW(compareStored(twice, twice, {}), StoredMismatch);
  twice["scenes"][1]["width"] = 8;
  EXPECT_EQ(compareStored(twice, twice, {}).rows.size(), 4u) << "another size is another row";
  Json before = resultOf(1), edited = resultOf(1);
  before["scenes"][0]["scene_hash"] = "0000000000000001";
  edited["scenes"][0]["scene_hash"] = "0000000000000002";
  EXPECT_THROW(compareStored(before, edited, {}), StoredMismatch);
  EXPECT_EQ(compareStored(before, before, {}).rows.size(), 2u);
}

TEST(Stored, otherMachinesAndOtherFilesAreRefused) {
  Json other = resultOf(1);
  other["machine"]["cpu"] = "another CPU";
  EXPECT_THROW(compareStored(resultOf(1), other, {}), StoredMismatch);
  EXPECT_THROW(compareStored(resultOf(1), Json::object(), {}), StoredMismatch);
  other = resultOf(1);
  other["scenes"][0]["scene"] = "another";
  EXPECT_THROW(compareStored(resultOf(1), other, {}), StoredMismatch);
}

}  // namespace
}  // namespace wavecrest
