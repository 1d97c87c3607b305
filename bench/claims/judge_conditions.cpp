#include "bench/claims/judge_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "bench/claims/comparison.h"
#include "bench/claims/loss_comparisons.h"
#include "bench/claims/reached_later.h"
#include "bench/score_text.h"

namespace wavecrest {
namespace {

using V = ClaimVerdict;

constexpr size_t kBiasSnapshots = 3;  // that must agree on a share of bias

// Whether a list "a; b" has the text.
bool lists(const std::string& list, const std::string& text) {
  return ("; " + list + "; ").find("; " + text + "; ") != std::string::npos;
}

// Judges one condition on one scene: makes its comparisons and keeps the one that decides.
class Judge {
 public:
  Judge(const Condition& condition, const SceneLosses& scene) : condition_(condition), scene_(scene), losses_(scene) {}

  Judgement judge() {
    for (const std::string& method : condition_.methods) requireMeasured(scene_, method);
    for (const std::string& method : condition_.than) requireMeasured(scene_, method);
    // Bias and slopes have measurements of their own. Every other kind compares the condition's metrics.
    if (condition_.kind == ConditionKind::biased) {
      biased();
    } else if (condition_.kind == ConditionKind::stalls) {
      stalls();
    } else {
      for (const std::string& metric : condition_.metrics) {
        showValues(metric);
        judgeMetric(metric);
      }
    }
    return result_;
  }

 private:
  // A method in print: the row that it is judged by.
  std::string shown(const std::string& method) const { return scene_.rowOf(method); }

  // ---- what is collected --------------------------------------------------------------------------------------------

  // Adds a text to the evidence, unless it is there already.
  void note(const std::string& text) {
    if (!lists(result_.evidence, text)) result_.evidence += (result_.evidence.empty() ? "" : "; ") + text;
  }

  // Keeps the comparison with the heaviest verdict. Among equal verdicts it keeps the one with the smallest margin: the
  // clearest failure, or the closest success.
  void add(const Comparison& comparison) {
    const bool heavier = !any_ || comparison.verdict > result_.verdict;
    const bool same = any_ && comparison.verdict == result_.verdict;
    if (!heavier && !(same && comparison.margin < margin_)) return;
    any_ = true;
    result_.verdict = comparison.verdict;
    result_.figure = comparison.text;
    margin_ = comparison.margin;
  }

  // Without values of a method the condition cannot be judged, unless another comparison fails. A margin of -infinity
  // puts this text before those of other comparisons that were not judged.
  void requireMeasured(const SceneLosses& scene, const std::string& method) {
    const std::string gap = scene.missing(method);
    if (gap.empty()) return;
    note(gap);
    add({V::notJudged, -std::numeric_limits<double>::infinity(), gap});
  }
  bool measured(const std::string& method) const { return scene_.missing(method).empty(); }

  // A score in print. Where it is below a limit, which is the least that `reaches` asks for, it never reads as that.
  std::string scoreText(double score, int digits) const {
    const bool limited = condition_.kind == ConditionKind::reaches || condition_.kind == ConditionKind::misses;
    if (!limited) return fmt::format("{:.{}g}", score, digits);
    return scoreBesideTarget(score, condition_.score, true, digits);
  }

  // Adds the scores of all methods, with their bands, and the noise floor to the evidence.
  void showValues(const std::string& metric) {
    std::vector<std::string> methods = condition_.methods;
    for (const std::string& method : condition_.than) {
      if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
    }
    std::string line;
    for (const std::string& method : methods) {
      const std::vector<double> values = scene_.scores(method, metric);
      if (values.empty()) continue;
      const Band band = meanBand(values);
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", shown(method), scoreText(band.mean, 4));
      line += plusMinus(band.halfWidth);
    }
    if (const std::optional<double> floor = scene_.floorLoss(metric)) {
      line += fmt::format(" (noise floor {})", scoreText(scoreOfLoss(metric, *floor), 4));
    } else if (scene_.isUnbiased(metric)) {
      line += " (without the reference's noise)";
    }
    note(metric + ": " + line);
  }

  // ---- comparisons --------------------------------------------------------------------------------------------------

  // Adds a comparison of each of `methods` with each of `than`.
  void forPairs(const std::function<Comparison(const std::string&, const std::string&)>& compare) {
    for (const std::string& a : condition_.methods) {
      for (const std::string& b : condition_.than) {
        if (a != b && measured(a) && measured(b)) add(compare(a, b));
      }
    }
  }

  // What stands for a comparison with a method that was not measured: it might have gone either way.
  Comparison unknown(const std::string& method) const { return {V::notJudged, 0, scene_.missing(method)}; }
  // Compares `a` with every other method of `than`.
  std::vector<Comparison> againstAll(const std::string& a,
                                     const std::function<Comparison(const std::string&)>& compare) const {
    std::vector<Comparison> all;
    for (const std::string& b : condition_.than) {
      if (b != a) all.push_back(measured(b) ? compare(b) : unknown(b));
    }
    return all;
  }

  // Puts each kind of condition in terms of losses, times or scores (ConditionKind).
  void judgeMetric(const std::string& metric) {
    switch (condition_.kind) {
      case ConditionKind::better:
        return forPairs([&](const auto& a, const auto& b) { return losses_.smallerLoss(metric, a, b); });
      case ConditionKind::faster:
        return forPairs([&](const auto& a, const auto& b) { return losses_.faster(metric, a, b); });
      case ConditionKind::good:
        return forPairs(
            [&](const auto& a, const auto& b) { return losses_.notLarger(metric, a, b, condition_.factor); });
      case ConditionKind::worseHere:
        return forPairs([&](const auto& a, const auto& b) {
          return losses_.worseHere(metric, a, b, condition_.control, condition_.factor);
        });
      case ConditionKind::equal:
        return equal(metric);
      case ConditionKind::poor:
      case ConditionKind::behind:
        return poorOrBehind(metric);
      case ConditionKind::leads:
        return leads(metric);
      case ConditionKind::reaches:
      case ConditionKind::misses:
        return threshold(metric);
      case ConditionKind::stalls:
      case ConditionKind::biased:
        return;
    }
  }

  // poor: the loss is larger than most others by the factor. behind: it is larger than at least one other.
  void poorOrBehind(const std::string& metric) {
    const bool poor = condition_.kind == ConditionKind::poor;
    for (const std::string& method : condition_.methods) {
      if (!measured(method)) continue;
      const auto all = againstAll(method, [&](const std::string& other) {
        return losses_.largerLoss(metric, method, other, poor ? condition_.factor : 1);
      });
      if (!all.empty()) add(poor ? middle(all) : best(all));
    }
  }

  // Each method is as good as its worst comparison. The best of the methods decides.
  void leads(const std::string& metric) {
    std::vector<Comparison> candidates;
    for (const std::string& method : condition_.methods) {
      if (!measured(method)) {
        candidates.push_back(unknown(method));
        continue;
      }
      const auto all = againstAll(method, [&](const std::string& other) {
        return losses_.notLarger(metric, method, other, condition_.factor);
      });
      if (!all.empty()) candidates.push_back(worst(all));
    }
    if (!candidates.empty()) add(best(candidates));
  }

  // Compares every pair both ways: neither loss may exceed the other by the factor.
  void equal(const std::string& metric) {
    for (const std::string& a : condition_.methods) {
      for (const std::string& b : condition_.methods) {
        if (a != b && measured(a) && measured(b)) add(losses_.notLarger(metric, a, b, condition_.factor));
      }
    }
  }

  // Compares scores themselves with the limit: at least for reaches, below for misses. Of methods that would reach it
  // later, the last to do so decides.
  void threshold(const std::string& metric) {
    const bool reaches = condition_.kind == ConditionKind::reaches;
    for (const std::string& method : condition_.methods) {
      if (!measured(method)) continue;
      const std::vector<double> values = scene_.scores(method, metric);
      if (values.empty()) {
        add({V::notJudged, 0, fmt::format("{} of {} was not measured", nameOf(metric), shown(method))});
        continue;
      }
      const Band band = scene_.scoreBand(method, metric);
      const std::string value = fmt::format("{} of {} is {}", nameOf(metric), shown(method), scoreText(band.mean, 3)),
                        text = fmt::format("{}, limit {:g}", value, condition_.score);
      Comparison result = reaches ? above(band, condition_.score, text) : below(band, condition_.score, text);
      if (reaches && result.verdict == V::fails) {
        const std::optional<ReachedLater> later = reachedLater(scene_, method, metric, condition_.score);
        if (later) result = {V::notReached, -later->seconds, value + "; " + later->text};
      }
      // Where an image without error would miss the score as well, missing it says nothing of the method.
      const std::optional<double> floor = scene_.floorLoss(metric);
      if (floor && *floor > lossOf(metric, condition_.score) && result.verdict != (reaches ? V::holds : V::fails)) {
        result = {
            V::notJudged, 0,
            fmt::format("{}; the reference's noise alone gives {}", value, scoreText(scoreOfLoss(metric, *floor), 3))};
      }
      add(result);
    }
  }

  // A control that stalls as well shows that something else holds the errors up, such as a biased reference.
  void stalls() {
    // The error of every control has to fall faster than the limit.
    std::string controls;
    for (const std::string& method : condition_.than) {
      if (!measured(method)) continue;
      if (scene_.errorSlopes(method).empty()) {
        add({V::notJudged, 0,
             fmt::format("no error of the control, {}, without the reference's noise was measured", shown(method))});
        continue;
      }
      const Band band = scene_.slopeBand(method);
      note(fmt::format("slope of {} {:.2f}{}", shown(method), band.mean, plusMinus(band.halfWidth)));
      controls += fmt::format(", control {} {:.2f}", shown(method), band.mean);
      const V falls = below(band, condition_.slope, "").verdict;
      if (falls == V::holds) continue;
      add({falls == V::undecided ? V::undecided : V::notJudged, 0,
           fmt::format("the control, {}, may stall as well: slope {:.2f}", shown(method), band.mean)});
    }
    // A method stalls if its slope is above the limit.
    for (const std::string& method : condition_.methods) {
      if (!measured(method)) continue;
      if (scene_.errorSlopes(method).empty()) {
        add({V::notJudged, 0, "no error without the reference's noise was measured"});
        continue;
      }
      const Band band = scene_.slopeBand(method);
      note(fmt::format("slope of {} {:.2f}{}", shown(method), band.mean, plusMinus(band.halfWidth)));
      add(above(band, condition_.slope,
                fmt::format("error of {} goes as t^{:.2f}, limit {:g}{}", shown(method), band.mean, condition_.slope,
                            controls)));
    }
  }

  // Compares the share of squared bias in the mean square error with the limit, at the last snapshots. They have to
  // agree.
  void biased() {
    for (const std::string& method : condition_.methods) {
      // Shares in order of snapshots.
      std::vector<double> shares;
      unsigned seeds = 0;
      for (const BiasRecord& bias : scene_.results().biases) {
        const bool ofMethod = bias.scene == scene_.name() && bias.method == scene_.rowOf(method);
        if (ofMethod && bias.meanSquareError > 0) {
          shares.push_back(bias.biasSquared / bias.meanSquareError);
          seeds = bias.seeds;
        }
      }
      if (shares.size() > kBiasSnapshots) shares.erase(shares.begin(), shares.end() - kBiasSnapshots);
      if (shares.empty()) {
        if (measured(method))
          add({V::notJudged, 0, "bias of " + shown(method) + " was not measured: it takes several seeds"});
        continue;
      }
      // The share has to reach the limit at all of these snapshots, or at none.
      const auto reached = std::count_if(shares.begin(), shares.end(), [&](double s) { return s >= condition_.share; });
      V verdict = reached == static_cast<std::ptrdiff_t>(shares.size()) ? V::holds
                  : reached == 0                                        ? V::fails
                                                                        : V::undecided;
      // The last snapshot gives the figure.
      std::string text = fmt::format("bias^2 of {} is {:.1f} % of its mean square error, limit {:g} %", shown(method),
                                     100 * shares.back(), 100 * condition_.share);
      if (seeds < kFewestSeedsForShare) {
        verdict = V::undecided;
        text += fmt::format(", by {} seeds", seeds);
      }
      note(text);
      add({verdict, shares.back() - condition_.share, text});
    }
  }

  const Condition& condition_;
  const SceneLosses& scene_;
  const LossComparisons losses_;
  Judgement result_;
  bool any_ = false;
  double margin_ = 0;
};

}  // namespace

void Judgement::add(const Judgement& other) {
  if (figure.empty() || other.verdict > verdict) {
    verdict = other.verdict;
    figure = other.figure;
  }
  if (other.evidence.empty() || lists(evidence, other.evidence)) return;
  evidence += (evidence.empty() ? "" : "; ") + other.evidence;
}

Judgement judgeCondition(const Condition& condition, const SceneLosses& scene) {
  return Judge(condition, scene).judge();
}

}  // namespace wavecrest
