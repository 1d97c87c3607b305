#include "bench/claims/reached_later.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/claims/claim_needs.h"

namespace wavecrest {

std::optional<ReachedLater> reachedLater(const SceneLosses& scene, const std::string& method, const std::string& metric,
                                         double score) {
  const std::optional<TimeToLoss> time = scene.timeToLoss(method, metric, lossOf(metric, score));
  if (!time || !(time->slope.mean + time->slope.halfWidth < 0)) return std::nullopt;
  // The runs have missed the score, so it is reached after their end.
  const double end = scene.endSeconds(method);
  const auto later = [end](double at) { return std::max(at, end); };
  const double seconds = later(time->seconds);
  if (!(seconds <= kFarthestTime * end)) return std::nullopt;
  // What takes longer than the study had, by its paths, does not lack time.
  const std::optional<double> share = studyPathShare(scene, method);
  if (!share || !(seconds / end * *share <= 1)) return std::nullopt;
  const double low = roundedTime(later(time->low)), high = roundedTime(later(time->high));
  const bool open = !(time->high <= kFarthestTime * end);
  const std::string interval = open ? fmt::format("{:g} s or longer", low) : fmt::format("{:g} to {:g} s", low, high);
  return ReachedLater{
      .seconds = seconds,
      .text = fmt::format("at this rate {:g} after {:g} s ({})", score, roundedTime(seconds), interval)};
}

}  // namespace wavecrest
