#include "bench/claims/judge_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "bench/claims/claim_needs.h"
#include "bench/claims/comparison.h"
#include "bench/claims/reached_later.h"

namespace wavecrest {
namespace {

using V = ClaimVerdict;

constexpr double kNearFloor = 2;      // times the loss that the reference's noise alone gives
constexpr size_t kBiasSnapshots = 3;  // that must agree on a share of bias

// Judges one condition on one scene: makes its comparisons and keeps the one that decides.
class Judge {
 public:
  Judge(const Condition& condition, const SceneLosses& scene) : condition_(condition), scene_(scene) {}

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
    if (result_.evidence.find(text) == std::string::npos) {
      result_.evidence += (result_.evidence.empty() ? "" : "; ") + text;
    }
  }

  // Keeps the comparison with the heaviest verdict. Among equal verdicts it keeps the one with the smallest margin: the
  // clearest failure, or the closest success.
  void add(const Comparison& comparison) {
    const bool heavier = !any_ || weightOf(comparison.verdict) > weightOf(result_.verdict);
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
      line += fmt::format("{}{} {:.4g}", line.empty() ? "" : ", ", shown(method), band.mean);
      line += plusMinus(band.halfWidth);
    }
    if (const std::optional<double> floor = scene_.floorLoss(metric)) {
      line += fmt::format(" (noise floor {:.4g})", scoreOfLoss(metric, *floor));
    } else if (scene_.isUnbiased(metric)) {
      line += " (without the reference's noise)";
    }
    note(metric + ": " + line);
  }

  // ---- comparisons --------------------------------------------------------------------------------------------------

  // Whether a mean loss is mostly the noise of the reference.
  bool nearFloor(const std::string& metric, std::span<const double> logLosses) const {
    const std::optional<double> floor = scene_.floorLoss(metric);
    return floor && meanOfLog(logLosses) <= kNearFloor * *floor;
  }

  // Whether the loss of `a` is at least `factor` times that of `b`.
  Comparison largerLoss(const std::string& metric, const std::string& a, const std::string& b, double factor) const {
    const std::vector<double> lossesA = scene_.logLosses(a, metric), lossesB = scene_.logLosses(b, metric);
    if (lossesA.empty() || lossesB.empty()) return {V::notJudged, 0, nameOf(metric) + " was not measured"};
    std::string text =
        fmt::format("{} {} {:.3g}, {} {:.3g}", nameOf(metric), shown(a), meanBand(scene_.scores(a, metric)).mean,
                    shown(b), meanBand(scene_.scores(b, metric)).mean);
    if (factor != 1)
      text += fmt::format(", losses {:.2g} : 1, limit {:g}", meanOfLog(lossesA) / meanOfLog(lossesB), factor);
    Comparison result = above(scene_.lossDifference(metric, a, b), std::log(factor), text);
    // Where even the larger one is mostly noise of the reference, the true losses may differ by any factor.
    if (result.verdict != V::holds && nearFloor(metric, lossesA) && nearFloor(metric, lossesB)) {
      result.verdict = V::notJudged;
      result.text +=
          fmt::format("; the reference's noise alone gives {:.3g}", scoreOfLoss(metric, *scene_.floorLoss(metric)));
    }
    return result;
  }
  // The comparison of the opposite question: a verdict that is decided turns round.
  static Comparison negated(Comparison c) {
    c.margin = -c.margin;
    if (c.verdict == V::holds || c.verdict == V::fails) c.verdict = c.verdict == V::holds ? V::fails : V::holds;
    return c;
  }

  // Whether the loss of `a` is within the factor of that of `b`.
  Comparison notLarger(const std::string& metric, const std::string& a, const std::string& b) const {
    return withTime(negated(largerLoss(metric, a, b, condition_.factor)), metric, a, b, condition_.factor);
  }

  // Takes the best loss that both methods reach. Compares the time that each needs to get there.
  Comparison faster(const std::string& metric, const std::string& a, const std::string& b) const {
    const std::vector<double> lossesA = scene_.logLosses(a, metric), lossesB = scene_.logLosses(b, metric);
    if (lossesA.empty() || lossesB.empty()) return {V::notJudged, 0, nameOf(metric) + " was not measured"};
    // The larger final loss is the best one that both reach.
    const double loss = std::max(meanOfLog(lossesA), meanOfLog(lossesB));
    const std::vector<double> timesA = scene_.logTimes(a, metric, loss), timesB = scene_.logTimes(b, metric, loss);
    // A logarithm of time varies by that of a loss over the slope of the curve.
    Band band = differenceBand(timesB, timesA);
    if (timesA.size() == 1 || timesB.size() == 1) {
      const double flattest =
          std::min(steepness(a, metric, meanOfLog(timesA)), steepness(b, metric, meanOfLog(timesB)));
      band.halfWidth = scene_.lossDifference(metric, a, b).halfWidth / flattest;
    }
    Comparison result =
        above(band, 0,
              fmt::format("to {} {:.3g} {} takes {:.3g} s, {} {:.3g} s", nameOf(metric), scoreOfLoss(metric, loss),
                          shown(a), meanOfLog(timesA), shown(b), meanOfLog(timesB)));
    if (result.margin == 0) result.verdict = V::undecided;  // both have it at their first snapshots
    if (result.verdict != V::holds && nearFloor(metric, lossesA) && nearFloor(metric, lossesB)) {
      result.verdict = V::notJudged;
      result.text += "; that is the reference's own noise";
    }
    return withTime(std::move(result), metric, a, b, 1);
  }

  // How steeply a loss falls about a time: minus d log(loss) / d log(time), at least 0.
  double steepness(const std::string& method, const std::string& metric, double seconds) const {
    const std::vector<double> slopes = scene_.lossSlopes(method, metric, seconds);
    return slopes.empty() ? 0 : std::max(0.0, -meanBand(slopes).mean);
  }

  // A comparison of `a` and `b` that fails because the loss of `a` is not within the factor of that of `b`. Where it
  // falls faster, so that at these rates it would be within the time that the study had, time is what it lacks. Near
  // the reference's noise every curve is flat, so `b` has to be above it.
  Comparison withTime(Comparison comparison, const std::string& metric, const std::string& a, const std::string& b,
                      double factor) const {
    if (comparison.verdict != V::fails || nearFloor(metric, scene_.logLosses(b, metric))) return comparison;
    const std::optional<double> shareA = studyPathShare(scene_, a), shareB = studyPathShare(scene_, b);
    const double end = scene_.endSeconds(a);
    const double closing = steepness(a, metric, end) - steepness(b, metric, end);
    const double behind = meanOfLog(scene_.logLosses(a, metric)) / meanOfLog(scene_.logLosses(b, metric)) / factor;
    if (!shareA || !shareB || !(closing > 0) || !(behind > 1)) return comparison;
    const double times = std::pow(behind, 1 / closing);  // as long as the runs
    if (!(times * std::min(*shareA, *shareB) <= 1)) return comparison;
    comparison.verdict = V::notReached;
    comparison.text +=
        fmt::format("; at these rates {} after {:g} s", factor == 1 ? "level" : "within it", roundedTime(times * end));
    return comparison;
  }

  // Adds a comparison of each of `methods` with each of `than`.
  void forPairs(const std::function<Comparison(const std::string&, const std::string&)>& compare) {
    for (const std::string& a : condition_.methods) {
      for (const std::string& b : condition_.than) {
        if (a != b && measured(a) && measured(b)) add(compare(a, b));
      }
    }
  }

  // Those that hold come first, by how clearly they do; those that fail come last.
  static bool isClearer(const Comparison& x, const Comparison& y) {
    const auto rank = [](const Comparison& c) {
      switch (c.verdict) {
        case V::holds:
          return 0;
        case V::undecided:
          return 1;
        case V::notJudged:
          return 2;
        case V::notReached:
          return 3;
        case V::fails:
          break;
      }
      return 4;
    };
    return rank(x) != rank(y) ? rank(x) < rank(y) : x.margin > y.margin;
  }
  static Comparison best(const std::vector<Comparison>& all) {
    return *std::min_element(all.begin(), all.end(), isClearer);
  }
  static Comparison worst(const std::vector<Comparison>& all) {
    return *std::max_element(all.begin(), all.end(), isClearer);
  }
  // The comparison in the middle. It holds where more than half of all do.
  static Comparison middle(std::vector<Comparison> all) {
    std::sort(all.begin(), all.end(), isClearer);
    return all[all.size() / 2];
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
        return forPairs(
            [&](const auto& a, const auto& b) { return withTime(largerLoss(metric, b, a, 1), metric, a, b, 1); });
      case ConditionKind::faster:
        return forPairs([&](const auto& a, const auto& b) { return faster(metric, a, b); });
      case ConditionKind::good:
        return forPairs([&](const auto& a, const auto& b) { return notLarger(metric, a, b); });
      case ConditionKind::worseHere:
        return forPairs([&](const auto& a, const auto& b) { return worseHere(metric, a, b); });
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
        return largerLoss(metric, method, other, poor ? condition_.factor : 1);
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
      const auto all = againstAll(method, [&](const std::string& other) { return notLarger(metric, method, other); });
      if (!all.empty()) candidates.push_back(worst(all));
    }
    if (!candidates.empty()) add(best(candidates));
  }

  // Compares every pair both ways: neither loss may exceed the other by the factor.
  void equal(const std::string& metric) {
    for (const std::string& a : condition_.methods) {
      for (const std::string& b : condition_.methods) {
        if (a != b && measured(a) && measured(b)) add(notLarger(metric, a, b));
      }
    }
  }

  // Whether `a` is further behind `b` here than in the control, by the factor.
  Comparison worseHere(const std::string& metric, const std::string& a, const std::string& b) {
    const SceneLosses control = scene_.other(condition_.control);
    // The logarithm of the ratio of losses in a scene.
    const auto behind = [&](const SceneLosses& scene) -> std::optional<Band> {
      if (scene.logLosses(a, metric).empty() || scene.logLosses(b, metric).empty()) return std::nullopt;
      return scene.lossDifference(metric, a, b);
    };
    const std::optional<Band> here = behind(scene_), there = behind(control);
    if (!here || !there) return {V::notJudged, 0, "the control, " + condition_.control + ", was not measured"};
    // The two scenes are independent, so half widths add as squares.
    const Band band{here->mean - there->mean, std::hypot(here->halfWidth, there->halfWidth)};
    return above(band, std::log(condition_.factor),
                 fmt::format("{} loss of {} over {}: {:.2g} here, {:.2g} in {}", nameOf(metric), shown(a), shown(b),
                             std::exp(here->mean), std::exp(there->mean), condition_.control));
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
      const std::string value = fmt::format("{} of {} is {:.3g}", nameOf(metric), shown(method), band.mean),
                        text = fmt::format("{}, limit {:g}", value, condition_.score);
      Comparison result = reaches ? above(band, condition_.score, text) : below(band, condition_.score, text);
      if (reaches && result.verdict == V::fails) {
        const std::optional<ReachedLater> later = reachedLater(scene_, method, metric, condition_.score);
        if (later) result = {V::notReached, -later->seconds, value + "; " + later->text};
      }
      add(result);
    }
  }

  // A control that stalls as well shows that something else holds the errors up, such as a biased reference.
  void stalls() {
    // The error of every control has to fall faster than the limit.
    std::string controls;
    for (const std::string& method : condition_.than) {
      if (scene_.errorSlopes(method).empty()) continue;
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
  Judgement result_;
  bool any_ = false;
  double margin_ = 0;
};

}  // namespace

void Judgement::add(const Judgement& other) {
  if (figure.empty() || weightOf(other.verdict) > weightOf(verdict)) {
    verdict = other.verdict;
    figure = other.figure;
  }
  if (other.evidence.empty() || evidence.find(other.evidence) != std::string::npos) return;
  evidence += (evidence.empty() ? "" : "; ") + other.evidence;
}

Judgement judgeCondition(const Condition& condition, const SceneLosses& scene) {
  return Judge(condition, scene).judge();
}

}  // namespace wavecrest
