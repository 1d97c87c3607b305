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
    EXPECT_EQ(has(method, "--roulette"), method != Method::mlt);
  }
}

TEST(Knobs, leaveOutRouletteWhereChainsHaveNone) {
  const Scene scene = smallBox(48, 32);
  for (size_t i = 0; i < kMetropolisVariantNames.size(); ++i) {
    RenderSettings settings = settingsOf(Method::mlt);
    settings.metropolis.variant = static_cast<MetropolisVariant>(i);
    const auto variants = variantsOf(scene, settings);
    EXPECT_EQ(std::any_of(variants.begin(), variants.end(), [](const Variant& v) { return v.knob == "--rr-depth"; }),
              settings.metropolis.variant == MetropolisVariant::pssmlt)
        << kMetropolisVariantNames[i];
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

TEST(Knobs, intersectorsThatJoinOtherConnectionsTraceOtherPaths) {
  const Scene scene = smallBox(48, 32);
  for (const Method method : {Method::pt, Method::bpt, Method::vcm}) {
    for (const Variant& variant : variantsOf(scene, settingsOf(method))) {
      if (variant.knob != "--accel") continue;
      EXPECT_EQ(variant.samePaths, method == Method::pt || variant.value == "small") << toString(method);
    }
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
  EXPECT_EQ(chosen({"radius"}), "baseline float; --precision double; ") << "path tracing has none";
  EXPECT_TRUE(hasKnob(all, "kernels"));
  EXPECT_TRUE(hasKnob(all, "--kernels"));
  for (const char* word : {"radius", "", "baseline"}) EXPECT_FALSE(hasKnob(all, word)) << word;
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

// A table as of `seeds` images, with one setting beside the baseline that is worth naming.
TradeResult tableWith(const Bias& mean, bool biased, uint32_t seeds) {
  TradeResult result{.scene = "box", .method = Method::pt, .seeds = seeds, .rows = {}, .machine = {}};
  result.rows.resize(2);
  result.rows[0].knob = "baseline";
  result.rows[1].knob = "--rr-depth";
  result.rows[1].value = "2";
  result.rows[1].efficiency = {.value = 1.4, .interval = {1.3, 1.5}};
  result.rows[1].mean = mean;
  result.rows[1].biased = biased;
  return result;
}

TEST(Advice, followsFromTheTable) {
  const Bias far{.value = -0.078, .standardError = 0.01, .probability = 0.02};
  EXPECT_EQ(adviceOf(tableWith(far, false, 6)).find("--rr-depth"), std::string::npos) << "too far off to be named";
  const Bias near{.value = -0.004, .standardError = 0.003, .probability = 0.2};
  const std::string told = adviceOf(tableWith(near, false, 6));
  EXPECT_NE(
      told.find("--rr-depth 2: 1.4 times the efficiency, no bias told from chance, its mean being off by -0.4 +-0.3 %"),
      std::string::npos)
      << told;
  EXPECT_NE(adviceOf(tableWith(near, true, 6)).find("biased by -0.4 +-0.3 %"), std::string::npos);
  EXPECT_NE(
      toText(tableWith(near, false, 6)).find("any of the 4 verdicts of this table false with a probability of 1 %"),
      std::string::npos);
}

TEST(Advice, comparesWithTheBaselineWhichHasNotTheDefaults) {
  TradeResult result = tableWith({}, false, 6);
  result.rows[1].efficiency.interval.low = 0.9;
  EXPECT_EQ(adviceOf(result), "box, pt: nothing here is worth more than its cost; the baseline is as good as any.");
  EXPECT_NE(toText(result).find("baseline: the settings of the study"), std::string::npos);
}

TEST(Advice, saysThatFewSeedsCannotTell) {
  const Bias near{.value = -0.004, .standardError = 1e-9, .probability = 1e-9};
  EXPECT_NE(adviceOf(tableWith(near, false, 2)).find("2 seeds cannot tell whether its mean"), std::string::npos);
  EXPECT_NE(toText(tableWith(near, false, 2)).find("2 seeds cannot tell; expected --seeds 4 or more"),
            std::string::npos);
}

TEST(Advice, saysThatErrorsOfFewChainRendersMislead) {
  TradeResult result = tableWith({.value = 0.01, .standardError = 0.02, .probability = 0.6}, false, 6);
  EXPECT_EQ(toText(result).find("errors of mlt"), std::string::npos);
  result.method = Method::mlt;
  EXPECT_NE(toText(result).find("doubt: errors of mlt from few renders are too small"), std::string::npos);
}

TEST(Advice, saysThatAReferenceBlurs) {
  TradeResult result = tableWith({}, false, 6);
  result.referenceMethod = Method::vcm;
  EXPECT_EQ(toText(result).find("which blurs"), std::string::npos);
  result.referenceBiased = true;
  EXPECT_NE(toText(result).find("doubt: the reference is by vcm, which blurs"), std::string::npos);
}

// Two images by Sobol points may be alike by chance.
TEST(Tradeoff, givesNoVerdictOfBiasWithTwoSeeds) {
  const TradeResult result = measureTrade(smallBox(48, 32), settingsOf(Method::pt),
                                          {.seconds = 1, .seeds = 2, .knobs = {"max-depth", "sampler"}});
  for (const TradeRow& row : result.rows) EXPECT_FALSE(row.biased) << row.knob << " " << row.value;
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
