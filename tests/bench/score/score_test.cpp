// A score is what the reference machine's rates make of the figures, and nobody gets one for another image.
#include "bench/score/score.h"

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

namespace wavecrest {
namespace {

ScoreRow rowOf(Method method, double score, Validity validity = Validity::right) {
  ScoreRow row;
  row.entry.scene = "cornell-diffuse";
  row.entry.method = method;
  row.validity = validity;
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
  EXPECT_TRUE(resultOf({rowOf(Method::pt, 1), rowOf(Method::lt, 1)}).allRight());
  for (const Validity validity : {Validity::wrong, Validity::unknown}) {
    const ScoreResult result = resultOf({rowOf(Method::pt, 1), rowOf(Method::lt, 1, validity)});
    EXPECT_FALSE(result.allRight());
    EXPECT_FALSE(result.doubts().empty());
    EXPECT_FALSE(toJson(result).at("valid").get<bool>());
  }
}

}  // namespace
}  // namespace wavecrest
