#include "bench/statistics/time_to_loss.h"

#include <algorithm>
#include <cmath>

namespace wavecrest {
namespace {

constexpr double kFittedPart = 0.25;  // of a run's time, from where its points are fitted
constexpr size_t kLeastPoints = 3;
constexpr double kBend = 0.75;

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
std::vector<LogPoint> lastPart(const std::vector<LossPoint>& run) {
  std::vector<LogPoint> points;
  for (const LossPoint& point : run) {
    const bool late = point.seconds >= kFittedPart * run.back().seconds;
    if (late && point.seconds > 0 && std::isfinite(point.loss) && point.loss > 0) {
      points.push_back({std::log(point.seconds), std::log(point.loss)});
    }
  }
  return points;
}

}  // namespace

std::optional<TimeToLoss> timeToLoss(std::span<const std::vector<LossPoint>> runs, double loss) {
  std::vector<double> times, slopes, ends;  // of each seed; times are logarithms
  Line line;
  for (const std::vector<LossPoint>& run : runs) {
    const std::vector<LogPoint> points = lastPart(run);
    if (points.size() < kLeastPoints) return std::nullopt;
    line = lineThrough(points);
    if (!(line.slope < 0)) return std::nullopt;
    times.push_back(line.meanTime + (std::log(loss) - line.meanLoss) / line.slope);
    slopes.push_back(line.slope);
    ends.push_back(points.back().time);
  }
  if (times.empty()) return std::nullopt;
  Band time = meanBand(times), slope = meanBand(slopes);
  if (times.size() == 1) {
    // Where the line meets the loss, by the errors of its height and of its slope.
    const double away = time.mean - line.meanTime, quantile = studentQuantile(line.points - 2);
    const double error =
        std::sqrt(line.residual * (1 / line.points + away * away / line.sumTime)) / std::abs(line.slope);
    time.halfWidth = quantile * error;
    slope.halfWidth = quantile * std::sqrt(line.residual / line.sumTime);
  }
  time.halfWidth = std::max(time.halfWidth, kBend * (time.mean - meanOf(ends).mean));
  return TimeToLoss{.seconds = std::exp(time.mean),
                    .low = std::exp(time.mean - time.halfWidth),
                    .high = std::exp(time.mean + time.halfWidth),
                    .slope = slope};
}

double roundedTime(double seconds) {
  if (!(seconds > 0) || !std::isfinite(seconds)) return seconds;
  const double step = std::pow(10, std::floor(std::log10(seconds)) - 1);
  return std::round(seconds / step) * step;
}

}  // namespace wavecrest
