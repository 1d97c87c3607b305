// What plots, tables and exports read off a series: its mean curve over seeds, its value at the end, and the time to a
// score. In one place, so that a figure in a table is always that of the curve beside it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// The snapshots of one number of all runs of a series.
struct CurvePoint {
  double seconds = 0, iterations = 0;  ///< means over runs
  double mean = 0, low = 0, high = 0;  ///< of the metric, over runs
};

/// One point for each number of a snapshot, in their order. Snapshots that no run has a finite value for are left out.
std::vector<CurvePoint> meanCurve(const ReportSeries& series, size_t metric);

/// The value of a metric at the end of a series: mean over its runs, NaN if one ends without a number.
double finalValue(const ReportSeries& series, size_t metric);

/// The extremes of its runs there.
struct Range {
  double low = 0, high = 0;
};
Range finalRange(const ReportSeries& series, size_t metric);

/// Squared bias over mean square error; nothing of fewer than kFewestSeedsForShare seeds, and where the error is not
/// above 0 or not known.
std::optional<double> shareOfBias(const ReportBias& bias);

/// Render seconds at the end of a series: mean over its runs.
double finalSeconds(const ReportSeries& series);

/// Whether a is the better score. A number is better than no number.
bool isBetter(const ReportMetric& metric, double a, double b);

/// A score in print: three digits, or as many as it takes where it misses the metric's target.
std::string formatScore(const ReportMetric& metric, double score);

/// What an image without error scores against the scene's reference, where that is known.
std::optional<double> noiseFloorOf(const ReportScene& scene, size_t metric);

/// The best of the final values of all series of a scene; NaN if there is none.
double bestFinalValue(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex);

/// From when on a score is there. atMost: all snapshots have it, so it may have been sooner.
struct TargetTime {
  double seconds = 0;
  bool atMost = false;
};
/// The time from which on all points of the mean curve have a score or a better one: between snapshots by straight
/// lines over the logarithm of time. Nothing if the last point does not have it, even where an earlier one does.
std::optional<TargetTime> timeToReach(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                                      double target);
/// "2.1 s", or "≤ 0.1 s".
std::string formatTime(const TargetTime& time);

/// Whether a series is the best of its scene beyond noise: its final values against those of every other one, by the
/// 95 % band of their difference over seeds. A single seed has no band, so none is best.
bool isClearlyBest(const ReportScene& scene, const ReportSeries& series, const ReportMetric& metric,
                   size_t metricIndex);
/// The same of the time to a score: against those that reach it. A series whose time is an upper bound is first only
/// before those that take longer than that.
bool isClearlyFastest(const ReportScene& scene, const ReportSeries& series, const ReportMetric& metric,
                      size_t metricIndex, double target);

/// The index of the metric with this key, if the report has it.
std::optional<size_t> findMetric(const ConvergenceReport& report, std::string_view key);

/// Every method that occurs, in the order of kMethodStyles, then any others.
std::vector<std::string> methodsOf(const ConvergenceReport& report);

/// Colours of the methods that have none in plot.css, as rules of a style sheet: in order of appearance.
std::string coloursOfOthers(const ConvergenceReport& report);

/// What a table over scenes calls a series. Several series of a scene may share a method: those of other settings, and
/// those of other programs whose names have one identifier.
struct SeriesName {
  std::string method, label;
  bool operator==(const SeriesName&) const = default;
};

/// Every one that occurs, in the order of methodsOf().
std::vector<SeriesName> seriesNamesOf(const ConvergenceReport& report);

/// The first of them with this label, or else of this method.
std::optional<SeriesName> findSeriesName(const ConvergenceReport& report, const std::string& labelOrMethod);

/// The series of a scene with this name, or null.
const ReportSeries* seriesOf(const ReportScene& scene, const SeriesName& name);

}  // namespace wavecrest
