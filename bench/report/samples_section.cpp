#include "bench/report/samples_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"

namespace wavecrest {
namespace {

// The mean curve as far as logarithms can show it; empty where a snapshot does not know its samples.
std::vector<CurvePoint> curveOverSamples(const ReportSeries& series, size_t metricIndex) {
  for (const ReportRun& run : series.runs) {
    for (const ReportPoint& point : run.points) {
      if (point.iterations == 0) return {};
    }
  }
  std::vector<CurvePoint> curve = meanCurve(series, metricIndex);
  std::erase_if(curve, [](const CurvePoint& point) { return !(point.mean > 0) || !(point.seconds > 0); });
  return curve;
}

struct AtSamples {
  double error = 0, seconds = 0;
  bool isFirst = false;  // the first snapshot has more samples: the error was at least that, the time at most
};

// The curve after a number of samples that is at most that of its last point.
AtSamples atSamples(const std::vector<CurvePoint>& curve, double samples) {
  const auto next =
      std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& point) { return point.iterations >= samples; });
  if (next == curve.begin()) {
    return {.error = next->mean, .seconds = next->seconds, .isFirst = next->iterations > samples};
  }
  const CurvePoint& before = *(next - 1);
  const double logPart = std::log(samples / before.iterations) / std::log(next->iterations / before.iterations);
  const double part = (samples - before.iterations) / (next->iterations - before.iterations);
  return {.error = before.mean * std::pow(next->mean / before.mean, logPart),
          .seconds = before.seconds + part * (next->seconds - before.seconds)};
}

}  // namespace

std::optional<EqualSamples> equalSamples(const ReportSeries& series, const ReportSeries& baseline, size_t metricIndex) {
  const std::vector<CurvePoint> curve = curveOverSamples(series, metricIndex);
  const std::vector<CurvePoint> baseCurve = curveOverSamples(baseline, metricIndex);
  if (curve.empty() || baseCurve.empty()) return std::nullopt;
  const double samples = std::min(curve.back().iterations, baseCurve.back().iterations);
  const AtSamples own = atSamples(curve, samples), base = atSamples(baseCurve, samples);
  const int bound = own.isFirst ? -1 : base.isFirst ? 1 : 0;
  EqualSamples result{.samples = samples,
                      .error = {.factor = base.error / own.error, .bound = bound},
                      .overhead = {.factor = own.seconds / base.seconds, .bound = bound},
                      .gain = {}};
  if (bound == 0) result.gain = Factor{.factor = result.error.factor / result.overhead.factor, .bound = 0};
  return result;
}

std::string renderEqualSamples(const ConvergenceReport& report) {
  const std::optional<size_t> index = findMetric(report, "relmse");
  if (!index) return "";
  const auto compare = [&](const ReportSeries& method, const ReportSeries& baseline) {
    const std::optional<EqualSamples> equal = equalSamples(method, baseline, *index);
    if (!equal) return FactorCell{};
    return FactorCell{.factors = {equal->error, equal->overhead, equal->gain},
                      .hint = fmt::format("after {} samples per pixel", formatCount(equal->samples))};
  };
  const std::string tables =
      renderFactorTables(report, {.group = "samples", .labels = {"", "time", "gain"}, .compare = compare});
  if (tables.empty()) return "";
  return fmt::format(
      "<h3>{0} at equal samples, and overhead</h3><p class=\"facts\">The baseline's {0} over the method's, after as "
      "many samples per pixel as both have. <b>time</b>: the overhead, the method's render time for them over the "
      "baseline's. <b>gain</b>: the quotient, which is the gain at equal time where {0} falls as one over the samples; "
      "with bias it falls more slowly. A sample is a camera path in each pixel; where a method has light paths, an "
      "iteration has as many of them as there are pixels unless a setting says otherwise (lt: up to four times as "
      "many); of Metropolis light transport a sample is a mutation for each pixel. ≥ and ≤: one of them has more "
      "samples in its first snapshot than the other at its end, and nothing is extrapolated. –: not run, sample "
      "counts are not known, or the quotient of two bounds.</p>\n{1}",
      escapeHtml(report.metrics[*index].name), tables);
}

}  // namespace wavecrest
