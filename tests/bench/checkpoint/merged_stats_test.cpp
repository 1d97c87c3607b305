// Statistics of parts as those of their sum: what adds up, what follows from sums, and that nothing gets lost.
#include "bench/checkpoint/merged_stats.h"

#include <gtest/gtest.h>

#include <array>

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

const Json kSnapshots = Json::array({Json{{"index", 0}}});

// As a render writes them, in short.
Json statsOfPart(const Json& more = Json::object()) {
  Json stats = {{"method", "mlt"},
                {"threads", 2},
                {"camera_paths", 100},
                {"light_paths", 7},
                {"rays_closest", 300},
                {"rays_shadow", 20},
                {"render_seconds", 2.0},
                {"paths_per_second", 50.0},
                {"rays_per_second", 160.0},
                {"snapshots", Json::array()},
                {"parts", 1}};
  stats.update(more);
  return stats;
}

Json merged(const Json& a, const Json& b) { return mergedStats(std::array{a, b}); }

TEST(MergedStats, countsAndSecondsAddUpAndRatesFollowFromThem) {
  const Json sum = merged(statsOfPart(), statsOfPart({{"camera_paths", 300}, {"render_seconds", 6.0}}));
  EXPECT_EQ(sum.at("camera_paths"), 400);
  EXPECT_EQ(sum.at("render_seconds"), 8.0);
  EXPECT_EQ(sum.at("paths_per_second"), 50.0);
  EXPECT_EQ(sum.at("rays_per_second"), 80.0);
  EXPECT_EQ(sum.at("parts"), 2);
  EXPECT_EQ(sum.at("threads"), 2);
  EXPECT_FALSE(sum.contains("of_parts"));
}

TEST(MergedStats, theRateOfLightTracingCountsLightPaths) {
  EXPECT_EQ(merged(statsOfPart({{"method", "lt"}}), statsOfPart({{"method", "lt"}})).at("paths_per_second"), 3.5);
  const Json chosen = {{"method", "evcm"},
                       {"choice", {{"method", "lt"}, {"seconds", 1.0}, {"trials", Json::array({1, 2})}}}};
  const Json sum = merged(statsOfPart(chosen), statsOfPart(chosen));
  EXPECT_EQ(sum.at("paths_per_second"), 3.5);
  EXPECT_EQ(sum.at("choice"), Json({{"method", "lt"}, {"seconds", 2.0}, {"trials", Json::array({1, 2})}}));
}

TEST(MergedStats, aNumberThatIsInNoListHasAValueForEachPart) {
  const Json sum =
      merged(statsOfPart({{"new_counter", 3}, {"same", 5}}), statsOfPart({{"new_counter", 4}, {"same", 5}}));
  EXPECT_EQ(sum.at("same"), 5);
  EXPECT_FALSE(sum.contains("new_counter"));
  EXPECT_EQ(sum.at("of_parts"), Json({{"new_counter", Json::array({3, 4})}}));
  // Also through a sum of sums, and of one that a part does not have.
  const Json all = merged(sum, statsOfPart({{"new_counter", 3}}));
  EXPECT_EQ(all.at("of_parts"), Json({{"same", Json::array({5, nullptr})}, {"new_counter", Json::array({3, 4, 3})}}));
}

TEST(MergedStats, countsOfChainsAddUpAndAcceptancesAreOfAllSteps) {
  const auto chains = [](int steps, double acceptance, int longest, int dark) {
    return statsOfPart({{"large_steps", steps},
                        {"large_acceptance", acceptance},
                        {"longest_rejection", longest},
                        {"dark_proposals", dark},
                        {"stuck_runs", 1},
                        {"stuck_chains", Json::array({Json{{"chain", longest}, {"rejections", longest}}})}});
  };
  const Json sum = merged(chains(100, 0.5, 120, 4), chains(300, 0.1, 140, 5));
  EXPECT_EQ(sum.at("large_steps"), 400);
  EXPECT_DOUBLE_EQ(sum.at("large_acceptance").get<double>(), 0.2);
  EXPECT_EQ(sum.at("longest_rejection"), 140);
  EXPECT_EQ(sum.at("dark_proposals"), 9);
  EXPECT_EQ(sum.at("stuck_runs"), 2);
  EXPECT_EQ(sum.at("stuck_chains").at(0).at("chain"), 140);
  EXPECT_EQ(sum.at("stuck_chains").size(), 2u);
}

TEST(MergedStats, theSumHasNoSnapshotsAndTheNotesOfAllParts) {
  const Json sum = merged(statsOfPart({{"snapshots", kSnapshots}, {"notes", Json::array({"a", "b"})}}),
                          statsOfPart({{"notes", Json::array({"b", "c"})}}));
  EXPECT_EQ(sum.at("snapshots"), Json::array());
  EXPECT_EQ(sum.at("notes"), Json::array({"a", "b", "c"}));
}

TEST(MergedStats, stagesAddUpByPosition) {
  const auto part = [](const char* name, int items) {
    const Json stage = {{"name", name}, {"items", items}, {"seconds", 0.5}};
    return statsOfPart({{"stages", Json::array({stage})}});
  };
  const Json row = merged(part("extend", 3), part("extend", 4)).at("stages").at(0);
  EXPECT_EQ(row, Json({{"name", "extend"}, {"items", 7}, {"seconds", 1.0}}));
  EXPECT_TRUE(merged(part("extend", 3), part("shade", 4)).at("of_parts").contains("stages"));
}

TEST(MergedStats, whatIsOfOnePartOfTheImageIsLeftOut) {
  const Json sum = merged(statsOfPart({{"part", "1/2"}, {"first_iteration", 0}, {"relative_error", 0.1}}),
                          statsOfPart({{"part", "2/2"}, {"first_iteration", 9}, {"relative_error", 0.1}}));
  for (const char* key : {"part", "first_iteration", "relative_error", "of_parts"}) {
    EXPECT_FALSE(sum.contains(key)) << key;
  }
}

TEST(MergedStats, aSingleOneStaysAsItIs) {
  const Json part = statsOfPart({{"part", "1/2"}, {"snapshots", kSnapshots}});
  EXPECT_EQ(mergedStats(std::array{part}), part);
}

}  // namespace
}  // namespace wavecrest
