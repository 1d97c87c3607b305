#include "bench/report/speedup_section.h"

#include <fmt/format.h>

#include <cmath>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"

namespace wavecrest {

std::optional<Factor> speedUp(const ReportSeries& series, const ReportSeries& baseline, const ReportMetric& metric,
                              size_t metricIndex) {
  const double own = finalValue(series, metricIndex), base = finalValue(baseline, metricIndex);
  if (std::isnan(own) || std::isnan(base)) return std::nullopt;
  // An error that rises again is reached more than once. The baseline is as fast as itself all the same.
  if (&series == &baseline) return Factor{.factor = 1, .bound = 0};
  // The better one reaches the other's last error on its way.
  const bool ahead = !isBetter(metric, base, own);
  const std::optional<TargetTime> time =
      timeToReach(ahead ? series : baseline, metric, metricIndex, ahead ? base : own);
  const double end = finalSeconds(ahead ? baseline : series);
  if (!time || !(time->seconds > 0) || !(end > 0)) return std::nullopt;
  if (ahead) return Factor{.factor = end / time->seconds, .bound = time->atMost ? 1 : 0};
  return Factor{.factor = time->seconds / end, .bound = time->atMost ? -1 : 0};
}

std::string renderSpeedUps(const ConvergenceReport& report) {
  // Reviewers ask for relMSE; a report without it takes its first metric.
  const size_t index = findMetric(report, "relmse").value_or(0);
  const ReportMetric& metric = report.metrics[index];
  const std::string tables = renderFactorTables(
      report,
      {.group = "speedup", .labels = {""}, .compare = [&](const ReportSeries& method, const ReportSeries& base) {
         return FactorCell{.factors = {speedUp(method, base, metric, index)}};
       }});
  if (tables.empty()) return "";
  return fmt::format(
      "<h3>Speed-up at equal {0}</h3><p class=\"facts\">The baseline's render time over the method's, to the larger of "
      "their two {0} at the end{1}. ≥ and ≤: the first snapshot of the faster one has it already.</p>\n{2}",
      escapeHtml(metric.name),
      report.scenes.size() > 1 ? "; the mean is over the scenes that both have been run on" : "", tables);
}

}  // namespace wavecrest
