// How the metrics of metrics/metric_list.h are shown in a report. There is no second list: what follows from a metric's
// entry is derived from it.
#pragma once

#include <vector>

#include "bench/report/report_data.h"
#include "metrics/metric_list.h"

namespace wavecrest {

ReportMetric shownMetric(const Metric& metric);

/// The metrics that reports measure themselves: those that `compare` measures by default.
std::vector<const Metric*> reportedMetrics();

}  // namespace wavecrest
