// The table of `bench --tradeoff` for a terminal, and what to make of it.
#include <algorithm>
#include <cmath>

#include "bench/statistics/biased_reference.h"
#include "bench/statistics/chains_mislead.h"
#include "bench/text_lines.h"
#include "bench/tradeoff/tradeoff.h"

namespace wavecrest {
namespace {

constexpr double kWorthNaming = 1.05;  // efficiency over the baseline's
constexpr double kMostBias = 0.02;     // of the mean: beyond, an image is another image, not a faster one
constexpr size_t kMostNamed = 3;

// The setting as on the command line.
std::string nameOf(const TradeRow& row) { return row.value.empty() ? row.knob : row.knob + " " + row.value; }

std::string percent(const Bias& bias) {
  return fmt::format("{:+.2g} +-{:.1g} %", 100 * bias.value, 100 * bias.standardError);
}

// Whether the mean is off by more than is acceptable, by two standard errors.
bool isTooBiased(const TradeRow& row) {
  const double error = row.biased ? 0 : 2 * row.mean.standardError;
  return std::abs(row.mean.value) - error > kMostBias;
}

// The verdict and the figures of the table that it follows from.
std::string biasInWords(const TradeRow& row, uint32_t seeds) {
  const std::string mean = percent(row.mean);
  if (row.biased) return fmt::format("biased by {}, in a block {}", mean, percent(row.worstBlock));
  if (!tellsBias(seeds)) return fmt::format("{} seeds cannot tell whether its mean, off by {}, is biased", seeds, mean);
  return fmt::format("no bias told from chance, its mean being off by {}", mean);
}

}  // namespace

std::string adviceOf(const TradeResult& result) {
  // Settings whose whole interval of efficiency is worth naming, and whose bias is not too large.
  std::vector<const TradeRow*> gains;
  for (const TradeRow& row : result.rows) {
    if (row.refusal.empty() && !isTooBiased(row) && row.efficiency.interval.low > kWorthNaming) gains.push_back(&row);
  }
  const std::string where = fmt::format("{}, {}: ", result.scene, toString(result.method));
  if (gains.empty()) return where + "nothing here is worth more than its cost; the baseline is as good as any.";
  // The most efficient ones in a sentence.
  std::sort(gains.begin(), gains.end(),
            [](const TradeRow* a, const TradeRow* b) { return a->efficiency.value > b->efficiency.value; });
  if (gains.size() > kMostNamed) gains.resize(kMostNamed);
  std::string text = where;
  for (const TradeRow* row : gains) {
    text += fmt::format("{}{}: {:.2g} times the efficiency, {}", row == gains.front() ? "" : "; ", nameOf(*row),
                        row->efficiency.value, biasInWords(*row, result.seeds));
  }
  return text + ".";
}

std::string biasVerdictsInWords(const TradeResult& result) {
  if (!tellsBias(result.seeds)) {
    return fmt::format("bias: {} seeds cannot tell; expected --seeds {} or more", result.seeds, kFewestSeedsForBias);
  }
  return fmt::format(
      "biased: more than {:g} % off, where chance alone would make any of the {} verdicts of this table false with a "
      "probability of {:g} % (family-wise, Bonferroni)",
      100 * kNegligibleBias, verdictsOf(result.rows), 100 * kTradeLevel);
}

std::vector<std::string> doubtsAbout(const TradeResult& result) {
  std::vector<std::string> doubts = doubtsAbout(result.machine);
  if (result.referenceBiased) doubts.push_back(referenceBlurs(result.referenceMethod));
  if (result.method == Method::mlt && result.seeds < kFewestChainRenders) doubts.emplace_back(kChainsMislead);
  return doubts;
}

std::string toText(const TradeResult& result) {
  TextLines text;
  line(text, "{} {} {}x{}: {} iterations, {} seeds; reference: {} in double", result.scene, toString(result.method),
       result.width, result.height, result.iterations, result.seeds, toString(result.referenceMethod));
  for (const std::string& doubt : doubtsAbout(result)) line(text, "  doubt: {}", doubt);
  line(text, "  {:<28} {:>9} {:>13} {:>13} {:>10} {:>19} {:>19} {:>8}  {}", "setting", "M paths/s", "speed",
       "efficiency", "s to 1 %", "bias of the mean", "worst block", "MB", "");
  // A line for each setting. A setting that was refused has the reason in place of figures.
  for (const TradeRow& row : result.rows) {
    if (!row.refusal.empty()) {
      line(text, "  {:<28} {}", nameOf(row), row.refusal);
      continue;
    }
    line(text, "  {:<28} {:>9.3f} {:>13} {:>13} {:>10.3g} {:>19} {:>19} {:>8.1f}  {}", nameOf(row),
         1e-6 * row.pathsPerCpuSecond, times(row.speed), times(row.efficiency), row.secondsToPercent, percent(row.mean),
         percent(row.worstBlock), 1e-6 * static_cast<double>(row.bytes), row.biased ? "biased" : "");
  }
  // Energy is in the JSON only. The table says where it is unknown.
  const bool energy = std::any_of(result.rows.begin(), result.rows.end(),
                                  [](const TradeRow& row) { return row.joulesPerPath.has_value(); });
  if (!energy) line(text, "  energy: this machine does not tell (powercap)");
  line(text, "  {}", biasVerdictsInWords(result));
  line(text, "  {}", kBaselineInWords);
  line(text, "\n  {}", adviceOf(result));
  return fmt::to_string(text);
}

}  // namespace wavecrest
