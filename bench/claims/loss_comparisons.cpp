#include "bench/claims/loss_comparisons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bench/claims/claim_needs.h"
#include "bench/statistics/time_to_loss.h"

namespace wavecrest {
namespace {

using V = ClaimVerdict;

}  // namespace

// Whether a mean loss is mostly the noise of the reference.
bool LossComparisons::nearFloor(const std::string& metric, std::span<const double> logLosses) const {
  const std::optional<double> floor = scene_.floorLoss(metric);
  return floor && meanOfLog(logLosses) <= kNearFloor * *floor;
}

Comparison LossComparisons::largerLoss(const std::string& metric, const std::string& a, const std::string& b,
                                       double factor) const {
  const std::vector<double> lossesA = scene_.logLosses(a, metric), lossesB = scene_.logLosses(b, metric);
  if (lossesA.empty() || lossesB.empty()) return {V::notJudged, 0, nameOf(metric) + " was not measured"};
  std::string text =
      fmt::format("{} {} {:.3g}, {} {:.3g}", nameOf(metric), scene_.rowOf(a), meanBand(scene_.scores(a, metric)).mean,
                  scene_.rowOf(b), meanBand(scene_.scores(b, metric)).mean);
  if (factor != 1)
    text += fmt::format(", losses {:.2g} : 1, limit {:g}", meanOfLog(lossesA) / meanOfLog(lossesB), factor);
  const Band difference = scene_.lossDifference(metric, a, b);
  Comparison result = above(difference, std::log(factor), text);
  // Where even the larger one is mostly noise of the reference, the true losses may differ by any factor, but in the
  // direction that the measured ones show.
  const bool smaller = difference.mean < -difference.halfWidth;
  if (result.verdict != V::holds && !smaller && nearFloor(metric, lossesA) && nearFloor(metric, lossesB)) {
    result.verdict = V::notJudged;
    result.text +=
        fmt::format("; the reference's noise alone gives {:.3g}", scoreOfLoss(metric, *scene_.floorLoss(metric)));
  }
  return result;
}

Comparison LossComparisons::smallerLoss(const std::string& metric, const std::string& a, const std::string& b) const {
  return withTime(largerLoss(metric, b, a, 1), metric, a, b, 1);
}

Comparison LossComparisons::notLarger(const std::string& metric, const std::string& a, const std::string& b,
                                      double factor) const {
  return withTime(negated(largerLoss(metric, a, b, factor)), metric, a, b, factor);
}

Comparison LossComparisons::faster(const std::string& metric, const std::string& a, const std::string& b) const {
  const std::vector<double> lossesA = scene_.logLosses(a, metric), lossesB = scene_.logLosses(b, metric);
  if (lossesA.empty() || lossesB.empty()) return {V::notJudged, 0, nameOf(metric) + " was not measured"};
  // The larger final loss is the best one that both reach. It stays a logarithm, so that rounding decides no tie.
  const double wanted = std::max(meanBand(lossesA).mean, meanBand(lossesB).mean);
  const std::vector<double> timesA = scene_.logTimes(a, metric, wanted), timesB = scene_.logTimes(b, metric, wanted);
  // A logarithm of time varies by that of a loss over the slope of the curve.
  Band band = differenceBand(timesB, timesA);
  if (timesA.size() == 1 || timesB.size() == 1) {
    const double flattest = std::min(steepness(a, metric, meanOfLog(timesA)), steepness(b, metric, meanOfLog(timesB)));
    band.halfWidth = scene_.lossDifference(metric, a, b).halfWidth / flattest;
  }
  Comparison result = above(
      band, 0,
      fmt::format("to {} {:.3g} {} takes {}, {} {}", nameOf(metric), scoreOfLoss(metric, std::exp(wanted)),
                  scene_.rowOf(a), secondsText(meanOfLog(timesA)), scene_.rowOf(b), secondsText(meanOfLog(timesB))));
  // A seed that has the loss at its first snapshot may have had it sooner, so its method is not shown to be slower.
  const auto isUpperBound = [&](const std::string& method, const std::vector<double>& times) {
    const std::vector<double> first = scene_.logTimes(method, metric, std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < times.size(); ++i) {
      if (times[i] <= first[i]) return true;
    }
    return false;
  };
  const bool open = (result.verdict == V::holds && isUpperBound(b, timesB)) ||
                    (result.verdict == V::fails && isUpperBound(a, timesA));
  if (open || result.margin == 0) result.verdict = V::undecided;
  if (result.verdict == V::undecided && nearFloor(metric, lossesA) && nearFloor(metric, lossesB)) {
    result.verdict = V::notJudged;
    result.text += "; that is the reference's own noise";
  }
  return withTime(std::move(result), metric, a, b, 1);
}

// How steeply a loss falls about a time: minus d log(loss) / d log(time), at least 0.
double LossComparisons::steepness(const std::string& method, const std::string& metric, double seconds) const {
  const std::vector<double> slopes = scene_.lossSlopes(method, metric, seconds);
  return slopes.empty() ? 0 : std::max(0.0, -meanBand(slopes).mean);
}

// Turns a failed comparison into "not reached in this time" where the loss of `a` is more than `factor` times that of
// `b`, but falls faster, and at these rates would be within the factor in the time that the study had. Near the
// reference's noise every curve is flat, so nothing changes if the loss of `b` is there.
Comparison LossComparisons::withTime(Comparison comparison, const std::string& metric, const std::string& a,
                                     const std::string& b, double factor) const {
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

Comparison LossComparisons::worseHere(const std::string& metric, const std::string& a, const std::string& b,
                                      const std::string& control, double factor) const {
  const SceneLosses other = scene_.other(control);
  // The logarithm of the ratio of losses in a scene.
  const auto behind = [&](const SceneLosses& scene) -> std::optional<Band> {
    if (scene.logLosses(a, metric).empty() || scene.logLosses(b, metric).empty()) return std::nullopt;
    return scene.lossDifference(metric, a, b);
  };
  const std::optional<Band> here = behind(scene_), there = behind(other);
  if (!here || !there) return {V::notJudged, 0, "the control, " + control + ", was not measured"};
  // The two scenes are independent, so the squares of their half widths add up.
  const Band band{here->mean - there->mean, std::hypot(here->halfWidth, there->halfWidth)};
  Comparison result =
      above(band, std::log(factor),
            fmt::format("{} loss of {} over {}: {:.2g} here, {:.2g} in {}", nameOf(metric), scene_.rowOf(a),
                        scene_.rowOf(b), std::exp(here->mean), std::exp(there->mean), control));
  // A ratio of losses that are mostly the reference's noise is nearer to 1 than the true one.
  const auto isHidden = [&](const SceneLosses& scene) {
    const LossComparisons own(scene);
    return own.nearFloor(metric, scene.logLosses(a, metric)) && own.nearFloor(metric, scene.logLosses(b, metric));
  };
  if (isHidden(other) || (result.verdict != V::holds && isHidden(scene_))) {
    result = {V::notJudged, 0, result.text + "; the reference's own noise hides a ratio"};
  }
  return result;
}

}  // namespace wavecrest
