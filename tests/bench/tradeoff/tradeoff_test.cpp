// The table of a small scene: what must be in it, and that known biases are found and no others.
#include "bench/tradeoff/tradeoff.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

const TradeRow& rowOf(const TradeResult& result, const std::string& knob, const std::string& value) {
  const auto found = std::find_if(result.rows.begin(), result.rows.end(),
                                  [&](const TradeRow& row) { return row.knob == knob && row.value == value; });
  if (found == result.rows.end()) throw std::out_of_range(knob + " " + value);
  return *found;
}

TEST(Knobs, areThoseThatMeanSomethingForTheMethod) {
  const Scene scene = smallBox(48, 32);
  const auto has = [&](Method method, const std::string& knob) {
    const auto variants = variantsOf(scene, settingsOf(method));
    return std::any_of(variants.begin(), variants.end(), [&](const Variant& v) { return v.knob == knob; });
  };
  for (const Method method : {Method::pt, Method::vcm, Method::mlt}) {
    EXPECT_TRUE(has(method, "--precision"));
    EXPECT_EQ(has(method, "--radius"), method == Method::vcm);
    EXPECT_EQ(has(method, "--chains"), method == Method::mlt);
    EXPECT_EQ(has(method, "--sampler"), method != Method::mlt);
  }
}

TEST(Knobs, leaveOutConnectionRouletteWhereAllConnectionsAreJoined) {
  const Scene scene = smallBox(48, 32);
  for (const Accel accel : {Accel::small, Accel::bvh}) {
    RenderSettings settings = settingsOf(Method::bpt);
    settings.accel = accel;
    const auto variants = variantsOf(scene, settings);
    EXPECT_EQ(std::any_of(variants.begin(), variants.end(),
                          [](const Variant& v) { return v.knob == "--connection-roulette"; }),
              accel == Accel::bvh);
  }
}

TEST(Knobs, canBeChosenByNameAndAreComparedWithTheSame) {
  const auto all = variantsOf(smallBox(48, 32), settingsOf(Method::pt));
  const auto chosen = [&](const std::vector<std::string>& words) {
    std::string told;
    for (const Variant& v : chooseVariants(all, words)) told += v.knob + " " + v.value + "; ";
    return told;
  };
  EXPECT_EQ(chosen({"kernels"}), "baseline float; --precision double; kernels complete; ");
  EXPECT_EQ(chosen({"--precision", "kernels"}), "baseline float; --precision double; kernels complete; ");
  EXPECT_EQ(chosen({"precision"}), chosen({"--precision"}));
  EXPECT_THROW(chosen({"radius"}), std::invalid_argument) << "path tracing has none";
  EXPECT_THROW(chosen({""}), std::invalid_argument);
  EXPECT_THROW(chosen({"baseline"}), std::invalid_argument);
}

TEST(Tradeoff, rendersAsManySeedsAsAskedFor) {
  const TradeResult result =
      measureTrade(smallBox(48, 32), settingsOf(Method::pt), {.seconds = 1, .seeds = 3, .knobs = {"kernels"}});
  EXPECT_EQ(result.seeds, 3u);
  ASSERT_EQ(result.rows.size(), 3u);
  const TradeRow& row = rowOf(result, "kernels", "complete");
  EXPECT_GT(row.speed.value, 0);
  EXPECT_EQ(row.mean.value, rowOf(result, "baseline", "float").mean.value) << "the same bits as the set's own kernels";
}

TEST(Tradeoff, doesNotTestEveryPrimitiveOfALargeScene) {
  Scene scene = smallBox(48, 32);
  const Shape some = scene.shapes.front();
  for (int i = 0; i < 100; ++i) scene.shapes.push_back(some);
  const TradeResult result =
      measureTrade(scene, settingsOf(Method::pt), {.seconds = 1, .seeds = 2, .knobs = {"accel"}});
  EXPECT_NE(rowOf(result, "--accel", "small").refusal, "");
  EXPECT_EQ(rowOf(result, "--accel", "bvh").refusal, "");
}

TEST(Tradeoff, findsWhatShortPathsLeaveOutAndNoBiasInRounding) {
  const TradeResult result = measureTrade(smallBox(48, 32), settingsOf(Method::pt), {.seconds = 3});
  EXPECT_EQ(result.rows.front().knob, "baseline");
  EXPECT_EQ(result.rows.front().efficiency.value, 1);
  const TradeRow& shortPaths = rowOf(result, "--max-depth", "4");
  EXPECT_TRUE(shortPaths.biased);
  EXPECT_LT(shortPaths.mean.value, -0.02);
  EXPECT_GT(shortPaths.speed.value, 1);
  EXPECT_EQ(rowOf(result, "--precision", "double").mean.value, 0) << "what the others are compared with";
  for (const char* accel : {"small", "bvh", "embree"}) {
    const TradeRow& row = rowOf(result, "--accel", accel);
    EXPECT_TRUE(row.samePaths);
    EXPECT_LT(std::abs(row.mean.value), 1e-3) << accel;
    EXPECT_FALSE(row.biased) << accel;
  }
  for (const TradeRow& row : result.rows) {
    EXPECT_GT(row.pathsPerCpuSecond, 0) << row.knob;
    EXPECT_GT(row.bytes, 0u) << row.knob;
    EXPECT_GT(row.secondsToPercent, 0) << row.knob;
  }
  EXPECT_NE(adviceOf(result).find("cornell-diffuse, pt: "), std::string::npos);
}

}  // namespace
}  // namespace wavecrest
