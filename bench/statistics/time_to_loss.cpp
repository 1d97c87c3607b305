#include "bench/statistics/time_to_loss.h"

#include <algorithm>
#include <cmath>

#include "bench/statistics/line_fit.h"

namespace wavecrest {
namespace {

constexpr double kFittedPart = 0.25;  // of a run's time, from where its points are fitted
constexpr size_t kLeastPoints = 3;
constexpr double kBend = 0.75;

// Natural logarithms of time and loss in the last part of a run.
std::vector<LinePoint> lastPart(const std::vector<LossPoint>& run) {
  std::vector<LinePoint> points;
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
  LineFit line;
  for (const std::vector<LossPoint>& run : runs) {
    const std::vector<LinePoint> points = lastPart(run);
    const std::optional<LineFit> fit = lineThrough(points);
    if (points.size() < kLeastPoints || !fit || !(fit->slope < 0)) return std::nullopt;
    line = *fit;
    times.push_back(line.meanX + (std::log(loss) - line.meanY) / line.slope);
    slopes.push_back(line.slope);
    ends.push_back(points.back().x);
  }
  if (times.empty()) return std::nullopt;
  Band time = meanBand(times), slope = meanBand(slopes);
  if (times.size() == 1) {
    // Where the line meets the loss, by the errors of its height and of its slope.
    const double away = time.mean - line.meanX, quantile = studentQuantile(line.points - 2);
    const double error =
        std::sqrt(line.residual * (1 / line.points + away * away / line.squaresX)) / std::abs(line.slope);
    time.halfWidth = quantile * error;
    slope.halfWidth = quantile * std::sqrt(line.residual / line.squaresX);
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
