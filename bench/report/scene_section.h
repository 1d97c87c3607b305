// One scene of the report: plots of each metric over time, the images, the result table and where the time went.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// `<section>` for report.scenes[index].
std::string renderScene(const ConvergenceReport& report, size_t index);

/// The value of a metric at the end of a series: mean over its runs, NaN if there is none.
double finalValue(const ReportSeries& series, size_t metric);

/// The best of the final values of all series of a scene; NaN if there is none.
double bestFinalValue(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex);

}  // namespace wavecrest
