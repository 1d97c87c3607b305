// A score is what the reference machine's rates make of the figures, and nobody gets one for another image.
#include "bench/score/score.h"

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace wavecrest
