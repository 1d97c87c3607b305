#include "bench/report/series_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/score_text.h"
#include "bench/statistics/bands.h"

namespace wavecrest {

std::vector<CurvePoint> meanCurve(const ReportSeries& series, size_t metric) {
  // Snapshots of one number belong together. Runs may begin and end with different ones.
  std::map<unsigned, std::vector<const ReportPoint*>> byNumber;
  for (const ReportRun& run : series.runs) {
    for (const ReportPoint& point : run.points) {
      if (std::isfinite(point.values[metric])) byNumber[point.number].push_back(&point);
    }
  }
  // Average what all runs have of a number.
  std::vector<CurvePoint> curve;
  for (const auto& [number, points] : byNumber) {
    CurvePoint mean{.low = std::numeric_limits<double>::infinity(), .high = -std::numeric_limits<double>::infinity()};
    const auto count = static_cast<double>(points.size());
    for (const ReportPoint* point : points) {
      const double value = point->values[metric];
      mean.seconds += point->seconds / count;
      mean.iterations += static_cast<double>(point->iterations) / count;
      mean.mean += value / count;
      mean.low = std::min(mean.low, value);
      mean.high = std::max(mean.high, value);
    }
    curve.push_back(mean);
  }
  return curve;
}

double finalValue(const ReportSeries& series, size_t metric) {
  // A run that ends with NaN makes the mean NaN.
  double sum = 0, count = 0;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    sum += run.points.back().values[metric];
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

Range finalRange(const ReportSeries& series, size_t metric) {
  // fmin and fmax pass over NaN, so the range is NaN only if no run ends with a number.
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Range range{kNone, kNone};
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    range.low = std::fmin(range.low, run.points.back().values[metric]);
    range.high = std::fmax(range.high, run.points.back().values[metric]);
  }
  return range;
}

std::optional<double> shareOfBias(const ReportBias& bias) {
  if (bias.seeds < kFewestSeedsForShare || !(bias.meanSquareError > 0)) return std::nullopt;
  return bias.bias2 / bias.meanSquareError;
}

double finalSeconds(const ReportSeries& series) {
  double sum = 0, count = 0;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    sum += run.points.back().seconds;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

bool isBetter(const ReportMetric& metric, double a, double b) {
  // Any number is better than NaN. NaN is not better than NaN.
  if (std::isnan(a) || std::isnan(b)) return std::isnan(b) && !std::isnan(a);
  return metric.higherIsBetter ? a > b : a < b;
}

std::string formatScore(const ReportMetric& metric, double score) {
  if (!metric.target) return formatSignificant(score);
  return scoreBesideTarget(score, *metric.target, metric.higherIsBetter, 3);
}

std::optional<double> noiseFloorOf(const ReportScene& scene, size_t metric) {
  return metric < scene.noiseFloors.size() ? scene.noiseFloors[metric] : std::nullopt;
}

double bestFinalValue(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const ReportSeries& series : scene.series) {
    const double value = finalValue(series, metricIndex);
    if (isBetter(metric, value, best)) best = value;
  }
  return best;
}

std::optional<TargetTime> timeToReach(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                                      double target) {
  // Find the first point from which on all are as good as the target: an image without what a method finds late can be
  // better than the image with its noise.
  const std::vector<CurvePoint> curve = meanCurve(series, metricIndex);
  const auto worse = std::find_if(curve.rbegin(), curve.rend(),
                                  [&](const CurvePoint& point) { return isBetter(metric, target, point.mean); });
  const auto reached = worse.base();
  if (reached == curve.end()) return std::nullopt;
  // The first snapshot is good enough already: its time is an upper bound.
  if (reached == curve.begin()) return TargetTime{.seconds = reached->seconds, .atMost = true};
  // Interpolate the score linearly over log time. At time 0 there is no logarithm: take time itself.
  const CurvePoint& before = *(reached - 1);
  const double part = (target - before.mean) / (reached->mean - before.mean);
  if (!(before.seconds > 0)) return TargetTime{.seconds = before.seconds + part * (reached->seconds - before.seconds)};
  return TargetTime{.seconds = before.seconds * std::pow(reached->seconds / before.seconds, part)};
}

std::string formatTime(const TargetTime& time) { return (time.atMost ? "≤ " : "") + formatSeconds(time.seconds); }

namespace {

// Whether the mean of a lies below the mean of b beyond noise, by the 95 % band of their difference. A single value has
// no band, so the answer is no.
bool isClearlyLess(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() < 2 || b.size() < 2) return false;
  const Band band = differenceBand(b, a);
  return band.mean - band.halfWidth > 0;
}

// The finite values of a metric at the ends of the runs, with the sign such that less is better.
std::vector<double> finalValues(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex) {
  std::vector<double> values;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty() || !std::isfinite(run.points.back().values[metricIndex])) continue;
    const double value = run.points.back().values[metricIndex];
    values.push_back(metric.higherIsBetter ? -value : value);
  }
  return values;
}

// The logarithm of the time that each seed takes to the target. A seed that does not reach it counts with its end.
std::vector<double> logTimes(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                             double target) {
  std::vector<double> times;
  for (const ReportRun& run : series.runs) {
    if (run.points.empty()) continue;
    // In a series of this run alone the mean curve is the curve of the run.
    const ReportSeries alone{.runs = {run}};
    const std::optional<TargetTime> time = timeToReach(alone, metric, metricIndex, target);
    times.push_back(std::log(std::max(time ? time->seconds : run.points.back().seconds, 1e-9)));
  }
  return times;
}

// Whether a series is better than every other one of its scene. A series without competitors is not.
template <class Better>
bool isAheadOfAll(const ReportScene& scene, const ReportSeries& series, Better better) {
  return scene.series.size() > 1 &&
         std::all_of(scene.series.begin(), scene.series.end(),
                     [&](const ReportSeries& other) { return &other == &series || better(other); });
}

}  // namespace

bool isClearlyBest(const ReportScene& scene, const ReportSeries& series, const ReportMetric& metric,
                   size_t metricIndex) {
  if (std::isnan(finalValue(series, metricIndex))) return false;
  const std::vector<double> own = finalValues(series, metric, metricIndex);
  return isAheadOfAll(scene, series, [&](const ReportSeries& other) {
    const std::vector<double> values = finalValues(other, metric, metricIndex);
    // A series without any value loses to one that has values.
    return values.empty() ? !own.empty() : isClearlyLess(own, values);
  });
}

bool isClearlyFastest(const ReportScene& scene, const ReportSeries& series, const ReportMetric& metric,
                      size_t metricIndex, double target) {
  if (!timeToReach(series, metric, metricIndex, target)) return false;
  const std::vector<double> own = logTimes(series, metric, metricIndex, target);
  return isAheadOfAll(scene, series, [&](const ReportSeries& other) {
    const std::optional<TargetTime> time = timeToReach(other, metric, metricIndex, target);
    // A time that is only an upper bound may have been shorter. A series that never gets there counts with its end.
    if (time && time->atMost) return false;
    return isClearlyLess(own, logTimes(other, metric, metricIndex, target));
  });
}

std::optional<size_t> findMetric(const ConvergenceReport& report, std::string_view key) {
  for (size_t m = 0; m < report.metrics.size(); ++m) {
    if (report.metrics[m].key == key) return m;
  }
  return std::nullopt;
}

std::vector<std::string> methodsOf(const ConvergenceReport& report) {
  std::vector<std::string> methods;
  for (const ReportScene& scene : report.scenes) {
    for (const ReportSeries& series : scene.series) {
      if (std::find(methods.begin(), methods.end(), series.method) == methods.end()) methods.push_back(series.method);
    }
  }
  std::stable_sort(methods.begin(), methods.end(),
                   [](const std::string& a, const std::string& b) { return methodRank(a) < methodRank(b); });
  return methods;
}

std::string coloursOfOthers(const ConvergenceReport& report) {
  constexpr size_t kColours = 6;  // --x0 to --x5 in plot.css
  std::string css;
  size_t others = 0;
  for (const std::string& method : methodsOf(report)) {
    if (methodRank(method) < kMethodStyles.size()) continue;
    append(css, ".m-{} {{ color: var(--x{}); }}\n", escapeHtml(method), others++ % kColours);
  }
  return css;
}

std::vector<SeriesName> seriesNamesOf(const ConvergenceReport& report) {
  std::vector<SeriesName> names;
  for (const std::string& method : methodsOf(report)) {
    for (const ReportScene& scene : report.scenes) {
      for (const ReportSeries& series : scene.series) {
        if (series.method != method) continue;
        const SeriesName name{.method = method, .label = series.label};
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
  }
  return names;
}

std::optional<SeriesName> findSeriesName(const ConvergenceReport& report, const std::string& labelOrMethod) {
  const std::vector<SeriesName> names = seriesNamesOf(report);
  for (const auto part : {&SeriesName::label, &SeriesName::method}) {
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const SeriesName& name) { return name.*part == labelOrMethod; });
    if (found != names.end()) return *found;
  }
  return std::nullopt;
}

const ReportSeries* seriesOf(const ReportScene& scene, const SeriesName& name) {
  const auto found = std::find_if(scene.series.begin(), scene.series.end(), [&](const ReportSeries& series) {
    return series.method == name.method && series.label == name.label;
  });
  return found == scene.series.end() ? nullptr : &*found;
}

}  // namespace wavecrest
