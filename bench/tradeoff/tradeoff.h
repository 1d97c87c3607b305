// What speed costs: for every setting that can be traded (knobs.h) its speed, noise, bias and memory.
//
// All settings render the same iterations with several seeds, in turn. From the spread over seeds follow noise and
// efficiency, 1 / (variance x CPU time); from the mean over seeds the bias. A setting that traces the paths of double
// precision is compared with it seed by seed, so that the bias is free of noise; any other with a reference in double.
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/machine_watch.h"
#include "bench/statistics/medians.h"
#include "bench/tradeoff/knobs.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// A difference of means, relative to the reference's mean, and how probable one as large is by chance alone.
struct Bias {
  double value = 0, standardError = 0;
  double probability = 1;
};
nlohmann::ordered_json biasJson(const Bias& bias);

struct TradeRow {
  std::string knob, value;
  std::string refusal;  // why the setting cannot render the scene; then there are no figures
  double pathsPerCpuSecond = 0;
  Estimate speed, efficiency;   // over the baseline's, seed by seed
  double secondsToPercent = 0;  // CPU time until the relative error is 1 %, by noise alone
  Bias mean;                    // of the image
  // The most significant block of 8 x 8 pixels among those off by more than kNegligibleBias, or among all if none is;
  // its probability is that of any block.
  Bias worstBlock;
  bool samePaths = false;  // compared seed by seed
  size_t bytes = 0;
  std::optional<double> joulesPerPath;

  // Whether bias was found, at the family level of the whole table; never where seeds are too few (tellsBias).
  bool biased = false;
};

struct TradeResult {
  std::string scene;
  Method method{};
  Method referenceMethod{};      // of settings with paths of their own
  bool referenceBiased = false;  // by merging (ReferenceChoice)
  uint32_t width = 0, height = 0, seeds = 0;
  uint64_t iterations = 0;     // of each image
  std::vector<TradeRow> rows;  // the baseline first
  MachineState machine;
};
// Relative differences below this are not called a bias. Where paths are the same, even a last bit that is always
// rounded the same way is statistically significant.
constexpr double kNegligibleBias = 1e-4;
constexpr double kTradeLevel = 0.01;  // probability that any verdict of bias in a table is false
// Of fewer images the spread is hardly known: two that happen to be alike make any difference look significant.
constexpr uint32_t kFewestSeedsForBias = 4;
inline bool tellsBias(uint32_t seeds) { return seeds >= kFewestSeedsForBias; }
// Verdicts in a table: one on the mean and one on the worst block of each setting that was rendered.
inline size_t verdictsOf(const std::vector<TradeRow>& rows) {
  return 2 * static_cast<size_t>(std::ranges::count_if(rows, [](const TradeRow& row) { return row.refusal.empty(); }));
}

struct TradeEffort {
  double seconds = 60;               // render time of everything, about
  uint32_t seeds = 6;                // at least two
  std::vector<std::string> knobs{};  // which settings are varied (chooseVariants); none: all
};
TradeResult measureTrade(const Scene& scene, const RenderSettings& base, const TradeEffort& effort);

std::string toText(const TradeResult& result);
nlohmann::ordered_json toJson(const TradeResult& result);
// Why its figures deserve doubt, a sentence each.
std::vector<std::string> doubtsAbout(const TradeResult& result);
// One page with a plot for each result: time to a relative error of 1 % against bias.
std::string tradePage(const std::vector<TradeResult>& results);
// What the baseline is, below the table.
constexpr std::string_view kBaselineInWords =
    "baseline: the settings of the study, as far as the method has them: --roulette throughput, --sampler independent, "
    "--merge-vertices all, --radius 0.001, one light walk to a camera walk; render has other defaults";
// What `biased` means in this table, with its error rate, or that there are too few seeds.
std::string biasVerdictsInWords(const TradeResult& result);
// What to do with this scene, in a sentence or two.
std::string adviceOf(const TradeResult& result);

}  // namespace wavecrest
