#include "bench/report/time_ahead.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/report/html_text.h"
#include "bench/statistics/time_to_loss.h"

namespace wavecrest {

bool isNearFloor(const ReportMetric& metric, double target, std::optional<double> floor) {
  if (!floor) return false;
  if (!metric.best) return isBetter(metric, target, *floor);
  return kNearFloor * std::abs(*metric.best - *floor) > std::abs(*metric.best - target);
}

std::optional<TimeAhead> timeAhead(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                                   double target, std::optional<double> floor) {
  if (!metric.best || timeToReach(series, metric, metricIndex, target)) return std::nullopt;
  if (isNearFloor(metric, target, floor)) return std::nullopt;
  std::vector<std::vector<LossPoint>> runs;
  for (const ReportRun& run : series.runs) {
    std::vector<LossPoint>& points = runs.emplace_back();
    for (const ReportPoint& point : run.points) {
      points.push_back({point.seconds, std::abs(*metric.best - point.values[metricIndex])});
    }
  }
  const std::optional<TimeToLoss> reached = timeToLoss(runs, std::abs(*metric.best - target));
  const double end = finalSeconds(series);
  if (!reached || !(end > 0) || !(reached->seconds <= kFarthestTime * end)) return std::nullopt;
  const auto after = [&](double seconds) { return std::max(0.0, seconds - end); };
  return TimeAhead{
      .seconds = after(reached->seconds), .interval = {after(reached->low), after(reached->high)}, .end = end};
}

bool isOpen(const TimeAhead& ahead) { return !(ahead.interval.high <= kFarthestTime * ahead.end); }

std::string formatTimeAhead(const TimeAhead& ahead) {
  const std::string low = formatSeconds(roundedTime(ahead.interval.low)),
                    high = formatSeconds(roundedTime(ahead.interval.high));
  return fmt::format("about {} more ({}{})", formatSeconds(roundedTime(ahead.seconds)), low,
                     isOpen(ahead) ? " or longer" : " to " + high);
}

}  // namespace wavecrest
