// How many times faster methods are than a baseline at equal error, scene by scene and in the geometric mean.
#pragma once

#include <optional>
#include <string>

#include "bench/report/factor_table.h"
#include "bench/report/report_data.h"

namespace wavecrest {

/// The baseline's render time over the method's, to the larger of their errors at the end: the one that both reach. A
/// bound where the first snapshot of the faster one has that error already. Nothing where one of them has no score, or
/// took no time.
std::optional<Factor> speedUp(const ReportSeries& series, const ReportSeries& baseline, const ReportMetric& metric,
                              size_t metricIndex);

/// A table for each baseline; empty where there is nothing to compare.
std::string renderSpeedUps(const ConvergenceReport& report);

}  // namespace wavecrest
