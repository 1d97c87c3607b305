// A recommendation as text and as JSON.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/recommend/duration_words.h"
#include "bench/recommend/recommend.h"
#include "bench/score_text.h"
#include "bench/text_lines.h"

namespace wavecrest {
namespace {

// The answer in words, after the doubts about it.
void addParagraph(TextLines& text, const Recommendation& all) {
  for (const std::string& doubt : all.doubts) line(text, "Doubt: {}.", doubt);
  if (!all.untold.empty()) {
    line(text, "{}: cannot tell within {}; try --budget {}. {}.", all.scene, durationWords(all.budget),
         budgetWord(all.suggestedBudget), all.untold);
    return;
  }
  const RecommendRow* best = all.best();
  if (best == nullptr) {
    line(text, "{}: no method gets to an SSIM of {:g} within {}; see what each has left in the column 'limit'.",
         all.scene, all.targetSsim, durationWords(kLongestSeconds));
    return;
  }
  const Prediction& p = best->prediction;
  line(text, "{}: use {}. It gets to an SSIM of {:g} in about {} ({} to {}).", all.scene, toString(best->method),
       all.targetSsim, durationWords(*p.seconds), durationWords(p.interval.low), durationWords(p.interval.high));
  if (all.rows.size() > 1 && all.rows[1].prediction.seconds) {
    line(text, "Next is {}, which takes {:.1f} times as long.", toString(all.rows[1].method),
         *all.rows[1].prediction.seconds / *p.seconds);
  }
}

// When a method gets to the target, in a few words. A bias that shrinks, and noise, are overcome in time; what a method
// does not sample stays away.
std::string timeWords(const RecommendRow& row) {
  if (!row.told) return "cannot tell";
  if (row.prediction.seconds) return durationWords(*row.prediction.seconds);
  return row.leavesOut.empty() ? "> " + durationWords(kLongestSeconds) : "leaves out";
}

nlohmann::ordered_json intervalJson(const Prediction& p) {
  using Json = nlohmann::ordered_json;
  if (!p.seconds) return {};
  return {p.interval.low, std::isfinite(p.interval.high) ? Json(p.interval.high) : Json()};
}

}  // namespace

std::string toText(const Recommendation& all) {
  TextLines text;
  addParagraph(text, all);
  if (all.rows.empty()) return fmt::to_string(text);
  line(text, "\n{:<7} {:>11} {:>21} {:>9} {:>7} {:>9}", "method", "time", "interval", "SSIM now", "limit", "pilot s");
  for (const RecommendRow& row : all.rows) {
    const Prediction& p = row.prediction;
    // A method that was refused has the reason in place of figures.
    if (!row.refusal.empty()) {
      line(text, "{:<7} {}", toString(row.method), row.refusal);
      continue;
    }
    if (!row.told) {
      line(text, "{:<7} {:>11} {}", toString(row.method), timeWords(row),
           fmt::format("four whole images take {} or more", durationWords(row.needed)));
      continue;
    }
    const std::string interval =
        p.seconds ? fmt::format("{} to {}", durationWords(p.interval.low), durationWords(p.interval.high)) : "";
    const auto ssim = [&](double value) { return scoreBesideTarget(value, all.targetSsim, true, 4, Digits::decimals); };
    line(text, "{:<7} {:>11} {:>21} {:>9} {:>7} {:>9.2f}  {}", toString(row.method), timeWords(row), interval,
         ssim(p.ssimNow), ssim(p.ssimLimit), row.pilotSeconds,
         p.seconds || row.leavesOut.empty() ? "" : "no paths " + row.leavesOut);
  }
  return fmt::to_string(text);
}

nlohmann::ordered_json toJson(const Recommendation& all) {
  using Json = nlohmann::ordered_json;
  // null stands for a method that does not reach the target, or of which nothing is known.
  const auto secondsJson = [](const Prediction& p) { return p.seconds ? Json(*p.seconds) : Json(); };
  Json table = Json::array();
  for (const RecommendRow& row : all.rows) {
    Json entry = {{"method", std::string(toString(row.method))}};
    if (!row.refusal.empty()) {
      entry["refused"] = row.refusal;
    } else {
      entry.update({{"told", row.told},
                    {"predicted_seconds", secondsJson(row.prediction)},
                    {"interval", intervalJson(row.prediction)},
                    {"ssim_now", row.prediction.ssimNow},
                    {"ssim_limit", row.prediction.ssimLimit},
                    {"leaves_out", row.leavesOut},
                    {"pilot_seconds", row.pilotSeconds}});
    }
    table.push_back(entry);
  }
  const RecommendRow* best = all.best();
  return {{"scene", all.scene},
          {"target_ssim", all.targetSsim},
          {"method", best == nullptr ? Json() : Json(std::string(toString(best->method)))},
          {"predicted_seconds", best == nullptr ? Json() : secondsJson(best->prediction)},
          {"interval", best == nullptr ? Json() : intervalJson(best->prediction)},
          {"interval_level", kIntervalLevel},
          {"cannot_tell", all.untold.empty() ? Json() : Json(all.untold)},
          {"suggested_budget", all.untold.empty() ? Json() : Json(all.suggestedBudget)},
          {"doubts", all.doubts},
          {"reference_method", std::string(toString(all.referenceMethod))},
          {"reference_ssim", all.referenceSsim},
          {"table", table}};
}

}  // namespace wavecrest
