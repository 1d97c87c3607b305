#include "bench/report/time_ahead.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/report/html_text.h"
#include "bench/statistics/bands.h"

namespace wavecrest {
namespace {

constexpr double kFittedPart = 0.25;  // of a run's time, from where its points are fitted
constexpr size_t kLeastPoints = 3;
constexpr double kFarthest = 100;  // times the render time

// Natural logarithms of time and loss.
struct LogPoint {
  double time, loss;
};

// A line through them, y = meanLoss + slope (x - meanTime), by least squares.
struct Line {
  double meanTime = 0, meanLoss = 0, slope = 0;
  double sumTime = 0;   // of squared distances from meanTime
  double residual = 0;  // variance of the points about the line
  double points = 0;
};

Line lineThrough(const std::vector<LogPoint>& points) {
  Line line{.points = static_cast<double>(points.size())};
  for (const LogPoint& point : points) {
    line.meanTime += point.time / line.points;
    line.meanLoss += point.loss / line.points;
  }
  double product = 0;
  for (const LogPoint& point : points) {
    line.sumTime += (point.time - line.meanTime) * (point.time - line.meanTime);
    product += (point.time - line.meanTime) * (point.loss - line.meanLoss);
  }
  line.slope = product / line.sumTime;
  for (const LogPoint& point : points) {
    const double off = point.loss - line.meanLoss - line.slope * (point.time - line.meanTime);
    line.residual += off * off / (line.points - 2);
  }
  return line;
}

// The last part of a run.
std::vector<LogPoint> lastPart(const ReportRun& run, double best, size_t metricIndex) {
  std::vector<LogPoint> points;
  if (run.points.empty()) return points;
  for (const ReportPoint& point : run.points) {
    const double loss = std::abs(best - point.values[metricIndex]);
    const bool late = point.seconds >= kFittedPart * run.points.back().seconds;
    if (late && point.seconds > 0 && std::isfinite(loss) && loss > 0) {
      points.push_back({std::log(point.seconds), std::log(loss)});
    }
  }
  return points;
}

}  // namespace

std::optional<TimeAhead> timeAhead(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                                   double target, std::optional<double> floor) {
  if (!metric.best || timeToReach(series, metric, metricIndex, target)) return std::nullopt;
  if (floor && isBetter(metric, target, *floor)) return std::nullopt;
  const double logLoss = std::log(std::abs(*metric.best - target));
  std::vector<double> times;  // logarithms, of each seed
  Line line;
  for (const ReportRun& run : series.runs) {
    const std::vector<LogPoint> points = lastPart(run, *metric.best, metricIndex);
    if (points.size() < kLeastPoints) return std::nullopt;
    line = lineThrough(points);
    if (!(line.slope < 0)) return std::nullopt;
    times.push_back(line.meanTime + (logLoss - line.meanLoss) / line.slope);
  }
  Band band = meanBand(times);
  if (times.size() == 1) {
    // Where the line meets the target, by the errors of its height and of its slope.
    const double away = band.mean - line.meanTime;
    const double error =
        std::sqrt(line.residual * (1 / line.points + away * away / line.sumTime)) / std::abs(line.slope);
    band.halfWidth = studentQuantile(line.points - 2) * error;
  }
  const double end = finalSeconds(series);
  if (!(end > 0) || !(std::exp(band.mean) <= kFarthest * end)) return std::nullopt;
  const auto after = [&](double logTime) { return std::max(0.0, std::exp(logTime) - end); };
  return TimeAhead{.seconds = after(band.mean),
                   .interval = {after(band.mean - band.halfWidth), after(band.mean + band.halfWidth)}};
}

std::string formatTimeAhead(const TimeAhead& ahead) {
  // Two digits: more would promise too much.
  const auto rounded = [](double seconds) {
    if (!(seconds > 0) || !std::isfinite(seconds)) return seconds;
    const double step = std::pow(10, std::floor(std::log10(seconds)) - 1);
    return std::round(seconds / step) * step;
  };
  const std::string low = formatSeconds(rounded(ahead.interval.low)),
                    high = formatSeconds(rounded(ahead.interval.high));
  const bool open = !(ahead.interval.high <= kFarthest * std::max(ahead.seconds, 1e-9));
  return fmt::format("about {} more ({}{})", formatSeconds(rounded(ahead.seconds)), low,
                     open ? " or longer" : " to " + high);
}

}  // namespace wavecrest
