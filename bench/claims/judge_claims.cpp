#include "bench/claims/judge_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "bench/statistics/bands.h"

namespace wavecrest {
namespace {

using V = ClaimVerdict;

// All must hold: one that fails decides.
V allOf(V a, V b) { return a == V::fails || b == V::fails ? V::fails : a == V::undecided ? a : b; }
// One must hold.
V anyOf(V a, V b) { return a == V::holds || b == V::holds ? V::holds : a == V::undecided ? a : b; }
V negated(V v) { return v == V::holds ? V::fails : v == V::fails ? V::holds : v; }

// Whether a value is at least a limit.
V atLeast(const Band& band, double limit) {
  if (band.mean - band.halfWidth >= limit) return V::holds;
  return band.mean + band.halfWidth < limit ? V::fails : V::undecided;
}

double lossOf(const std::string& metric, double score) {
  if (metric == "ssim") return 1 - score;
  if (metric == "q_mos") return 100 - score;
  return score;
}

constexpr double kNearFloor = 1.5;      // times the loss that the reference's noise alone gives
constexpr double kSmallestLoss = 1e-9;  // of images that equal the reference
constexpr double kSlopeSpan = 4;        // a slope is measured from a fraction of 1 / 4 of the time to the end
constexpr size_t kBiasSnapshots = 3;    // that must agree on a share of bias

// Judges the conditions of one claim and collects the evidence.
class Judge {
 public:
  Judge(const std::string& scene, const CampaignResults& results) : scene_(scene), results_(results) {}

  V judge(const Condition& condition) {
    V verdict = V::holds;
    for (const std::string& method : condition.methods) {
      if (const std::string gap = missing(method); !gap.empty()) {
        note(gap);
        verdict = allOf(verdict, V::undecided);
      }
    }
    if (condition.kind == ConditionKind::biased) return allOf(verdict, biased(condition));
    for (const std::string& metric : condition.metrics) {
      showValues(metric, condition);
      verdict = allOf(verdict, byMetric(metric, condition));
      noteOpenPoints(metric);
    }
    return verdict;
  }
  const std::string& evidence() const { return evidence_; }

 private:
  void note(const std::string& text) {
    if (evidence_.find(text) == std::string::npos) evidence_ += (evidence_.empty() ? "" : "; ") + text;
  }

  // Why a method has no values; empty if it has.
  std::string missing(const std::string& method) const {
    std::string gap = method + " was not measured";
    for (const RunRecord& run : results_.runs) {
      if (run.scene != scene_ || run.method != method) continue;
      if (run.state == RunState::done && !run.snapshots.empty()) return "";
      gap = method + " was refused";
    }
    return gap;
  }

  // A number of each seed's run, where it exists.
  template <class Function>
  std::vector<double> perSeed(const std::string& method, Function function) const {
    std::vector<double> values;
    for (const RunRecord& run : results_.runs) {
      if (run.scene != scene_ || run.method != method || run.snapshots.empty()) continue;
      const std::optional<double> value = function(run);
      if (value && std::isfinite(*value)) values.push_back(*value);
    }
    return values;
  }

  static std::optional<double> scoreOf(const SnapshotRecord& snapshot, const std::string& metric) {
    const auto value = snapshot.values.find(metric);
    return value == snapshot.values.end() ? std::nullopt : std::optional(value->second);
  }
  std::vector<double> scores(const std::string& method, const std::string& metric) const {
    return perSeed(method, [&](const RunRecord& run) { return scoreOf(run.snapshots.back(), metric); });
  }
  std::vector<double> logLosses(const std::string& method, const std::string& metric) const {
    std::vector<double> values = scores(method, metric);
    for (double& value : values) value = std::log(std::max(lossOf(metric, value), kSmallestLoss));
    return values;
  }

  void showValues(const std::string& metric, const Condition& condition) {
    std::vector<std::string> methods = condition.methods;
    for (const std::string& method : condition.than) {
      if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
    }
    std::string line;
    for (const std::string& method : methods) {
      const std::vector<double> values = scores(method, metric);
      if (values.empty()) continue;
      const Band band = meanBand(values);
      line += fmt::format("{}{} {:.4g}", line.empty() ? "" : ", ", method, band.mean);
      if (std::isfinite(band.halfWidth)) line += fmt::format(" \u00b1 {:.2g}", band.halfWidth);
    }
    const SceneRecord* scene = results_.findScene(scene_);
    if (scene != nullptr && scene->noiseFloors.contains(metric)) {
      line += fmt::format(" (noise floor {:.4g})", scene->noiseFloors.at(metric));
    }
    note(metric + ": " + line);
  }

  V byMetric(const std::string& metric, const Condition& condition) {
    switch (condition.kind) {
      case ConditionKind::better:
        return forPairs(condition, [&](const auto& a, const auto& b) {
          return explain(largerLoss(metric, b, a, 1), a + " against", b);
        });
      case ConditionKind::good:
        return forPairs(condition, [&](const auto& a, const auto& b) {
          return explain(negated(largerLoss(metric, a, b, condition.factor)),
                         fmt::format("{} within {:g} times", a, condition.factor), b);
        });
      case ConditionKind::poor:
        return poor(metric, condition);
      case ConditionKind::equal:
        return equal(metric, condition);
      case ConditionKind::reaches:
      case ConditionKind::misses:
        return threshold(metric, condition);
      case ConditionKind::stalls:
        return stalls(metric, condition);
      case ConditionKind::biased:
        break;
    }
    return V::undecided;
  }

  // Remembers a comparison of `subject` that does not hold, or is open.
  V explain(V verdict, const std::string& subject, const std::string& object) {
    if (verdict == V::holds) return verdict;
    const std::string point = (verdict == V::fails ? "not so: " : "open: ") + subject;
    const auto same = [&](const auto& known) { return known.first == point; };
    const auto known = std::find_if(openPoints_.begin(), openPoints_.end(), same);
    if (known == openPoints_.end()) {
      openPoints_.emplace_back(point, object);
    } else {
      known->second += ", " + object;
    }
    return verdict;
  }
  void noteOpenPoints(const std::string& metric) {
    for (const auto& [point, objects] : openPoints_) {
      note(std::string(point).append(" ").append(objects).append(" in ").append(metric));
    }
    openPoints_.clear();
  }

  V forPairs(const Condition& condition, const std::function<V(const std::string&, const std::string&)>& compare) {
    V verdict = V::holds;
    for (const std::string& a : condition.methods) {
      for (const std::string& b : condition.than) {
        if (a != b) verdict = allOf(verdict, compare(a, b));
      }
    }
    return verdict;
  }

  // Whether the loss of `a` is at least `factor` times that of `b`.
  V largerLoss(const std::string& metric, const std::string& a, const std::string& b, double factor) const {
    const std::vector<double> lossesA = logLosses(a, metric), lossesB = logLosses(b, metric);
    if (lossesA.empty() || lossesB.empty()) return V::undecided;
    const V verdict = atLeast(differenceBand(lossesA, lossesB), std::log(factor));
    // Where even the larger one is all noise of the reference, the true losses may differ by any factor.
    if (verdict == V::fails && nearFloor(metric, lossesA) && nearFloor(metric, lossesB)) return V::undecided;
    return verdict;
  }

  bool nearFloor(const std::string& metric, std::span<const double> logLosses) const {
    const SceneRecord* scene = results_.findScene(scene_);
    if (scene == nullptr || !scene->noiseFloors.contains(metric)) return false;
    return std::exp(meanBand(logLosses).mean) <= kNearFloor * lossOf(metric, scene->noiseFloors.at(metric));
  }

  V poor(const std::string& metric, const Condition& condition) {
    V verdict = V::holds;
    for (const std::string& method : condition.methods) {
      V beyondSome = V::fails;
      for (const std::string& other : condition.than) {
        if (other != method) beyondSome = anyOf(beyondSome, largerLoss(metric, method, other, condition.factor));
      }
      verdict = allOf(verdict,
                      explain(beyondSome, fmt::format("{} beyond {:g} times", method, condition.factor), "the best"));
    }
    return verdict;
  }

  V equal(const std::string& metric, const Condition& condition) {
    V verdict = V::holds;
    for (const std::string& a : condition.methods) {
      for (const std::string& b : condition.methods) {
        if (a == b) continue;
        verdict = allOf(verdict, explain(negated(largerLoss(metric, a, b, condition.factor)),
                                         fmt::format("{} within {:g} times", a, condition.factor), b));
      }
    }
    return verdict;
  }

  V threshold(const std::string& metric, const Condition& condition) {
    const bool reaches = condition.kind == ConditionKind::reaches;
    V verdict = V::holds;
    for (const std::string& method : condition.methods) {
      const std::vector<double> values = scores(method, metric);
      V own = values.empty() ? V::undecided : atLeast(meanBand(values), condition.score);
      if (!reaches) own = negated(own);
      verdict = allOf(
          verdict, explain(own, fmt::format("{} {:g} by", reaches ? "reaching" : "missing", condition.score), method));
    }
    return verdict;
  }

  // d log(loss) / d log(time) between a quarter of the time and the end.
  static std::optional<double> slopeOf(const RunRecord& run, const std::string& metric) {
    const SnapshotRecord& last = run.snapshots.back();
    const auto first = std::find_if(run.snapshots.begin(), run.snapshots.end(), [&](const SnapshotRecord& snapshot) {
      return snapshot.renderSeconds >= last.renderSeconds / kSlopeSpan;
    });
    const std::optional<double> a = scoreOf(*first, metric), b = scoreOf(last, metric);
    if (!a || !b || first->renderSeconds >= last.renderSeconds) return std::nullopt;
    const double lossA = std::max(lossOf(metric, *a), kSmallestLoss),
                 lossB = std::max(lossOf(metric, *b), kSmallestLoss);
    return std::log(lossB / lossA) / std::log(last.renderSeconds / first->renderSeconds);
  }

  V stalls(const std::string& metric, const Condition& condition) {
    V verdict = V::holds;
    for (const std::string& method : condition.methods) {
      const std::vector<double> slopes = perSeed(method, [&](const RunRecord& run) { return slopeOf(run, metric); });
      if (slopes.empty()) return V::undecided;
      const Band band = meanBand(slopes);
      note(fmt::format("slope of {} {:.2f} \u00b1 {:.2f}", method, band.mean, band.halfWidth));
      verdict = allOf(verdict, explain(atLeast(band, condition.slope), fmt::format("{} flatter than", method),
                                       fmt::format("{:g}", condition.slope)));
    }
    return verdict;
  }

  V biased(const Condition& condition) {
    V verdict = V::holds;
    for (const std::string& method : condition.methods) {
      std::vector<double> shares;
      for (const BiasRecord& bias : results_.biases) {
        if (bias.scene == scene_ && bias.method == method) shares.push_back(bias.biasSquared / bias.meanSquareError);
      }
      if (shares.size() > kBiasSnapshots) shares.erase(shares.begin(), shares.end() - kBiasSnapshots);
      const auto reached = std::count_if(shares.begin(), shares.end(), [&](double s) { return s >= condition.share; });
      V own = V::undecided;
      if (!shares.empty()) {
        note(fmt::format("bias^2 of {} is {:.1f} % of its mean square error", method, 100 * shares.back()));
        if (reached == static_cast<std::ptrdiff_t>(shares.size())) own = V::holds;
        if (reached == 0) own = V::fails;
      }
      verdict =
          allOf(verdict, explain(own, method + "'s bias^2 at least", fmt::format("{:g} %", 100 * condition.share)));
    }
    noteOpenPoints("mean square error");
    return verdict;
  }

  const std::string& scene_;
  const CampaignResults& results_;
  std::string evidence_;
  std::vector<std::pair<std::string, std::string>> openPoints_;  // of the metric under way: what, about whom
};

}  // namespace

std::string_view toString(ClaimVerdict verdict) {
  return verdict == V::holds ? "holds" : verdict == V::fails ? "does not hold" : "undecided";
}

ClaimRecord judgeClaim(const Claim& claim, const CampaignResults& results) {
  Judge judge(claim.scene, results);
  V verdict = V::holds;
  for (const Condition& condition : claim.conditions) verdict = allOf(verdict, judge.judge(condition));
  return {claim.id, claim.scene, claim.statement, std::string(toString(verdict)), judge.evidence()};
}

std::vector<ClaimRecord> judgeStudyClaims(const CampaignResults& results) {
  std::vector<ClaimRecord> records;
  if (results.campaign.contains("spp")) return records;
  for (const Claim& claim : studyClaims()) {
    if (results.findScene(claim.scene) != nullptr) records.push_back(judgeClaim(claim, results));
  }
  return records;
}

}  // namespace wavecrest
