#include "bench/report/scene_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"

namespace wavecrest {
namespace {

// A study's run has hundreds of snapshots; a curve needs no more than this, and the page must stay small.
constexpr size_t kMostPoints = 40;

constexpr const char* kTimeLabel = "render time in seconds";

// The curve itself if it is short. Otherwise points of it at even distances in the logarithm of time, with both ends.
template <class Point>
std::vector<Point> thinned(const std::vector<Point>& curve) {
  if (curve.size() <= kMostPoints) return curve;
  std::vector<Point> kept{curve.front()};
  // A first snapshot may be at time 0, which has no logarithm: times below a microsecond count as one.
  const double start = std::log(std::max(curve.front().seconds, 1e-6));
  const double step = (std::log(std::max(curve.back().seconds, 1e-6)) - start) / (kMostPoints - 1);
  if (!(step > 0)) return {curve.front(), curve.back()};
  double next = start + step;
  for (size_t i = 1; i + 1 < curve.size(); ++i) {
    const double at = std::log(std::max(curve[i].seconds, 1e-6));
    // Keep the first point at or after each of the even times.
    if (at < next) continue;
    kept.push_back(curve[i]);
    while (next <= at) next += step;
  }
  kept.push_back(curve.back());
  return kept;
}

// A curve in the style of its series, still without points.
PlotCurve emptyCurve(const ReportScene& scene, const ReportSeries& series) {
  return {.label = series.label,
          .cssClass = seriesClass(scene, series),
          .mark = methodStyle(series.method).mark,
          .points = {}};
}

// The law of the guide line, error ~ t^slope, in print.
std::string guideLabel(double slope) {
  if (slope == -0.5) return "1/√t";
  return slope == -1 ? "1/t" : fmt::format("t^{}", slope);
}

// ", 40 iterations", or nothing where they are not known.
std::string iterationsText(double iterations) {
  return iterations > 0 ? fmt::format(", {} iterations", formatCount(iterations)) : "";
}

// A metric over render time: for each series the mean over seeds, with the extremes over seeds as its band.
ScenePlot metricPlot(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex) {
  ScenePlot result{.key = metric.key, .heading = metric.name, .explanation = metric.explanation, .plot = {}};
  if (!metric.formula.empty()) result.explanation = metric.formula + "; " + result.explanation;
  // Set up the axes, the noise floor, the target and the guide.
  Plot& plot = result.plot;
  plot.title = metric.name + " over render time, " + scene.name;
  plot.xLabel = kTimeLabel;
  plot.yLabel = metric.name;
  plot.yScale = metric.logarithmic ? AxisScale::kLogarithmic : AxisScale::kLinear;
  if (scene.noiseFloors[metricIndex]) plot.floor = {*scene.noiseFloors[metricIndex], "noise of the reference"};
  plot.target = metric.target;
  if (metric.target) result.explanation += fmt::format("; line at {}", *metric.target);
  plot.guideSlope = metric.idealSlope;
  if (metric.idealSlope) plot.guideLabel = guideLabel(*metric.idealSlope);
  // Add a curve for each series.
  for (const ReportSeries& series : scene.series) {
    PlotCurve curve = emptyCurve(scene, series);
    for (const CurvePoint& point : thinned(meanCurve(series, metricIndex))) {
      curve.points.push_back(
          {.x = point.seconds,
           .y = point.mean,
           .low = point.low,
           .high = point.high,
           .tooltip = fmt::format("{}: {} {} after {}{}", series.label, metric.name, formatScore(metric, point.mean),
                                  formatSeconds(point.seconds), iterationsText(point.iterations))});
    }
    plot.curves.push_back(std::move(curve));
  }
  const bool hasBands =
      std::ranges::any_of(scene.series, [](const ReportSeries& series) { return series.runs.size() > 1; });
  if (hasBands) result.explanation += "; curve: mean over seeds, band: worst to best seed";
  return result;
}

// The share rather than bias itself: bias of an unbiased method comes out as noise of either sign, which no logarithmic
// axis could show.
ScenePlot biasPlot(const ReportScene& scene) {
  ScenePlot result{.key = "bias",
                   .heading = "Share of bias",
                   .explanation = "bias² over mean square error; scatters around 0 for an unbiased method",
                   .plot = {}};
  result.plot.title = "share of bias over render time, " + scene.name;
  result.plot.xLabel = kTimeLabel;
  result.plot.yLabel = "bias² / mean square error";
  result.plot.yScale = AxisScale::kLinear;
  for (const ReportSeries& series : scene.series) {
    PlotCurve curve = emptyCurve(scene, series);
    for (const ReportBias& bias : thinned(series.bias)) {
      const std::optional<double> share = shareOfBias(bias);
      if (!share) continue;
      curve.points.push_back({.x = bias.seconds,
                              .y = *share,
                              .low = *share,
                              .high = *share,
                              .tooltip = fmt::format("{}: bias² is {:.0f} % of the error after {}", series.label,
                                                     100 * *share, formatSeconds(bias.seconds))});
    }
    result.plot.curves.push_back(std::move(curve));
  }
  return result;
}

}  // namespace

std::string seriesClass(const ReportScene& scene, const ReportSeries& series) {
  // Count the series of the same method before this one: the first has solid lines, the next ones dashes of five kinds.
  int earlier = 0;
  for (const ReportSeries& other : scene.series) {
    if (&other == &series) break;
    earlier += other.method == series.method ? 1 : 0;
  }
  return fmt::format("m-{} variant-{}", escapeHtml(series.method), earlier % 6);
}

std::vector<ScenePlot> scenePlots(const ConvergenceReport& report, const ReportScene& scene) {
  std::vector<ScenePlot> plots;
  for (size_t m = 0; m < report.metrics.size(); ++m) plots.push_back(metricPlot(scene, report.metrics[m], m));
  const bool anyBias = std::any_of(scene.series.begin(), scene.series.end(), [](const ReportSeries& series) {
    return std::ranges::any_of(series.bias, [](const ReportBias& bias) { return shareOfBias(bias).has_value(); });
  });
  if (anyBias) plots.push_back(biasPlot(scene));
  return plots;
}

}  // namespace wavecrest
