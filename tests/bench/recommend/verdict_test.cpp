// When recommend has a verdict, and what it says where it has none.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bench/recommend/duration_words.h"
#include "bench/recommend/recommend.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

RecommendRow rowOf(Method method, double seconds, double low, double high) {
  RecommendRow row{.method = method, .told = true, .pilotSeconds = 1};
  row.prediction.seconds = seconds;
  row.prediction.ssimLimit = 1;
  row.prediction.interval = {low, high};
  return row;
}

// No prediction: the target is out of reach, or the pilot had no whole images.
RecommendRow rowWithout(Method method, bool told, double needed = 0) {
  return {.method = method, .told = told, .pilotSeconds = 1, .needed = needed};
}

Recommendation judged(std::vector<RecommendRow> rows) {
  Recommendation all{.scene = "box",
                     .targetSsim = 0.9,
                     .budget = 20,
                     .referenceMethod = Method::bpt,
                     .referenceSsim = 0.95,
                     .rows = std::move(rows)};
  judgeRows(all);
  return all;
}

TEST(Verdict, isTheSoonestMethod) {
  const Recommendation all = judged({rowOf(Method::pt, 30, 25, 40), rowOf(Method::bpt, 10, 8, 12)});
  ASSERT_NE(all.best(), nullptr);
  EXPECT_EQ(all.best()->method, Method::bpt);
  EXPECT_TRUE(all.doubts.empty());
  EXPECT_TRUE(toText(all).starts_with("box: use bpt."));
}

TEST(Verdict, aMissedSsimNeverReadsAsTheTarget) {
  RecommendRow missed = rowWithout(Method::lt, true);
  missed.prediction.ssimNow = 0.85;
  missed.prediction.ssimLimit = 0.89998;
  Recommendation all = judged({rowOf(Method::pt, 30, 25, 40), missed});
  EXPECT_NE(toText(all).find("0.8500 0.89998 "), std::string::npos) << toText(all);
  all.referenceSsim = 0.8996;
  judgeRows(all);
  EXPECT_NE(toText(all).find("known to an SSIM of 0.8996 only"), std::string::npos) << toText(all);
}

TEST(Verdict, isMissingWhereAMethodThatMayBeBestHasNoWholeImages) {
  const Recommendation all = judged({rowOf(Method::pt, 30, 25, 40), rowWithout(Method::bpt, false, 12)});
  EXPECT_EQ(all.best(), nullptr);
  EXPECT_TRUE(toText(all).starts_with("box: cannot tell within 20 s; try --budget 2m.")) << toText(all);
  EXPECT_TRUE(toJson(all)["method"].is_null());
  EXPECT_EQ(toJson(all)["suggested_budget"], 120);
  // One whose first image alone takes longer than the best takes in all is not the best.
  EXPECT_NE(judged({rowOf(Method::pt, 2, 1.5, 2.5), rowWithout(Method::bpt, false, 12)}).best(), nullptr);
}

TEST(Verdict, isMissingWhereTheIntervalIsNoAnswer) {
  EXPECT_EQ(judged({rowOf(Method::pt, 30, 10, 90)}).best(), nullptr);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NE(toText(judged({rowOf(Method::pt, 30, 25, infinity)})).find("the reference of bpt is too noisy"),
            std::string::npos);
}

TEST(Verdict, comesAfterItsDoubts) {
  const std::string text = toText(judged({rowOf(Method::pt, 30, 25, 40), rowOf(Method::bpt, 33, 26, 44)}));
  EXPECT_TRUE(text.starts_with("Doubt: bpt may be as soon, in 26 s at the earliest.\nbox: use pt.")) << text;
}

TEST(Verdict, onMltSaysWhatItsErrorsAreWorth) {
  EXPECT_TRUE(toText(judged({rowOf(Method::mlt, 30, 25, 40)})).starts_with("Doubt: errors of mlt from few renders"));
}

TEST(Verdict, neverSaysNever) {
  RecommendRow blind = rowWithout(Method::pt, true);
  blind.leavesOut = "A S D E";
  const std::string text = toText(
      judged({rowOf(Method::bpt, 10, 8, 12), blind, rowWithout(Method::ppm, true), rowWithout(Method::lt, false, 99)}));
  EXPECT_EQ(text.find("never"), std::string::npos) << text;
  EXPECT_NE(text.find("> 116 days"), std::string::npos) << text;
  EXPECT_NE(text.find("no paths A S D E"), std::string::npos) << text;
  EXPECT_NE(text.find("four whole images take 99 s or more"), std::string::npos) << text;
}

TEST(Pilots, takeTheSamplerThatRenderTakes) {
  for (const Method method : {Method::pt, Method::vcm, Method::ppm, Method::mlt}) {
    const RenderSettings own = pilotSettings({}, method);
    EXPECT_EQ(own.method, method);
    EXPECT_EQ(own.sampler == SamplerKind::sobol, method == Method::pt || method == Method::vcm) << toString(method);
  }
}

// cornell-spheres has paths that only merging samples.
TEST(Recommend, doubtsAReferenceThatBlurs) {
  RenderSettings settings;
  settings.isa = bestIsa();
  takeProgramDefaults(settings);
  for (const auto& [name, blurs] : {std::pair("cornell-spheres", true), std::pair("cornell-diffuse", false)}) {
    const Scene scene = loadScene(findScene(name), {.filmSize = std::array{32u, 24u}});
    const RenderSettings own = referenceSettings(settings, classifyPaths(scene).reference);
    EXPECT_EQ(own.radius, blurs ? std::optional(kFixedRadius) : std::nullopt) << name;
    const Recommendation told = recommend(scene, settings, {.seconds = 0.1, .methods = {Method::pt}});
    EXPECT_EQ(toText(told).find("Doubt: the reference is by vcm, which blurs.") != std::string::npos, blurs) << name;
  }
}

TEST(DurationWords, areNeverPowersOfTen) {
  EXPECT_EQ(durationWords(99.4), "99 s");
  EXPECT_EQ(durationWords(99.7), "2 min");
}

// Pilots are of whole images, however short their time.
TEST(Pilots, areWholeOrNone) {
  LoadOptions options;
  options.filmSize = {{160, 120}};
  const Scene scene = loadScene(findScene("cornell-diffuse"), options);
  RenderSettings settings;
  settings.isa = bestIsa();
  settings.threads = 1;
  settings.metropolis.bootstrapSamples = 4096;
  for (const MethodEntry& entry : kMethods) {
    settings.method = entry.method;
    for (const double seconds : {1e-6, 0.2}) {
      const PilotRender render = renderPilot(scene, settings, 1, seconds, ClockKind::cpu, false);
      if (seconds == 1e-6 && !strategiesOf(entry.method).merge) {
        EXPECT_FALSE(render.pilot) << entry.name;
        EXPECT_GT(render.needed, seconds) << entry.name;
      }
      if (!render.pilot) continue;
      EXPECT_GT(render.pilot->seconds, 0) << entry.name;
      // The ceiling is lit: a black row would be one without samples.
      for (const Image& part : render.pilot->parts) {
        float lowest = std::numeric_limits<float>::infinity();
        for (uint32_t y = 40; y < 110; y += 8) {
          double sum = 0;
          for (uint32_t x = 0; x < 3 * 160; ++x) sum += static_cast<double>(part.pixels[size_t{y} * 480 + x]);
          lowest = std::min(lowest, static_cast<float>(sum));
        }
        EXPECT_GT(lowest, 0) << entry.name << " " << seconds;
      }
    }
  }
}

}  // namespace
}  // namespace wavecrest
