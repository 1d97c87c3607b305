#include "bench/report/shown_metrics.h"

#include <fmt/format.h>

namespace wavecrest {
namespace {

// From here on people see no difference at a glance.
constexpr double kGoodSsim = 0.95, kGoodMos = 90;

}  // namespace

ReportMetric shownMetric(const Metric& metric) {
  ReportMetric shown;
  shown.key = scoreName(metric, metric.score);
  shown.name = metric.symbol;
  shown.explanation = fmt::format("{}; {} is better", metric.basis, metric.higherIsBetter ? "higher" : "lower");
  shown.formula = metric.formula;
  shown.higherIsBetter = metric.higherIsBetter;
  // Errors fall by orders of magnitude; scores that rise approach their ceiling.
  shown.logarithmic = !metric.higherIsBetter;
  if (metric.sampleExponent != 0) shown.idealSlope = metric.sampleExponent;
  if (!metric.higherIsBetter) shown.best = 0;
  if (metric.name == "ssim") {
    shown.target = kGoodSsim;
    shown.best = 1;
  }
  if (shown.key == "q_mos") {
    shown.target = kGoodMos;
    shown.best = 100;
  }
  return shown;
}

std::vector<const Metric*> reportedMetrics() {
  std::vector<const Metric*> metrics;
  for (const Metric& metric : metricList()) {
    if (metric.byDefault) metrics.push_back(&metric);
  }
  return metrics;
}

}  // namespace wavecrest
