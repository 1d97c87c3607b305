// A score is what the reference machine's rates make of the figures, and nobody gets one for another image.
#include "bench/score/score.h"

#include <gtest/gtest.h>
#include <linux/perf_event.h>

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

ScoreRow rowOf(Method method, double score, Validity validity = Validity::exact) {
  ScoreRow row;
  row.entry.scene = "cornell-diffuse";
  row.entry.method = method;
  row.image.validity = validity;
  row.score = score;
  row.coreScore = 0.5 * score;
  return row;
}

ScoreResult resultOf(std::vector<ScoreRow> rows) {
  ScoreResult result;
  result.rows = std::move(rows);
  return result;
}

TEST(Score, isTheGeometricMeanOfTheEntries) {
  const ScoreResult result = resultOf({rowOf(Method::pt, 100), rowOf(Method::pt, 400), rowOf(Method::vcm, 50)});
  EXPECT_NEAR(result.score(Method::pt), 200, 1e-9);
  EXPECT_NEAR(result.coreScore(Method::pt), 100, 1e-9);
  EXPECT_NEAR(result.score(), std::cbrt(100.0 * 400 * 50), 1e-9);
  EXPECT_EQ(result.score(Method::lt), 0);
}

TEST(Score, isValidOnlyIfEveryImageIs) {
  const ScoreResult valid = resultOf({rowOf(Method::pt, 1), rowOf(Method::lt, 1, Validity::tolerated)});
  EXPECT_TRUE(valid.allAccepted());
  EXPECT_TRUE(toJson(valid).at("valid").get<bool>());
  EXPECT_NE(toText(valid).find("images: 1 exact, 1 within tolerance"), std::string::npos);
  for (const Validity validity : {Validity::refused, Validity::unknown}) {
    const ScoreResult result = resultOf({rowOf(Method::pt, 1), rowOf(Method::lt, 1, validity)});
    EXPECT_FALSE(result.allAccepted());
    EXPECT_NE(toText(result).find("NOT VALID"), std::string::npos);
    EXPECT_FALSE(result.doubts().empty());
    EXPECT_FALSE(toJson(result).at("valid").get<bool>());
  }
}

// Counted in place of cycles: nanoseconds of the thread's CPU time, which Linux counts itself, and nothing.
constexpr PerfEvent kTime{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_TASK_CLOCK};
constexpr PerfEvent kNothing{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_DUMMY};

TEST(Score, countsEventsInASliceThatIsNotTimed) {
  const std::array<PerfEvent, kStageEvents> events{kTime, kNothing, kNothing};
  const std::string refusal = StageEventCounter(events).refusal();
  if (!refusal.empty()) GTEST_SKIP() << refusal;
  const Scene scene = smallBox(64, 48);
  ScoreRow row;
  row.entry = ScoreEntry{
      .scene = "cornell-diffuse", .method = Method::pt, .width = 64, .height = 48, .iterations = 8 * kScoreSlices};
  // Both are nanoseconds per path. Events of all slices over the items of one would always be eight times as many; a
  // busy machine makes a slice as slow now and then.
  double counted = 0, timed = 0;
  const auto agree = [&] { return counted > 0.3 * timed && counted < 3 * timed; };
  for (int attempt = 0; attempt < 8 && !agree(); ++attempt) {
    row.stages.clear();
    measureOneThread(scene, scoreSettings(scene, row.entry, bestIsa(), 1), events, row);
    EXPECT_EQ(stageObserver, nullptr) << "later renders are timed without a counter";
    counted = timed = 0;
    for (const ScoredStage& stage : row.stages) {
      counted += stage.eventsPerItem[0] * stage.share.itemsPerPath;
      timed += stage.share.nsPerPath.value;
      EXPECT_EQ(stage.eventsPerItem[1], 0) << stage.share.name;
    }
  }
  EXPECT_TRUE(agree()) << counted << " counted, " << timed << " timed";
  EXPECT_LT(row.pathsPerCpuSecond.interval.low, row.pathsPerCpuSecond.interval.high);
}

}  // namespace
}  // namespace wavecrest
