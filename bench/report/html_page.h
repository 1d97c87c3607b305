// The report as one HTML file that needs nothing but itself: style sheet, script, plots and images are all inside.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// The whole document. Throws std::invalid_argument if the per-metric vectors do not match report.metrics.
std::string renderReport(const ConvergenceReport& report);

}  // namespace wavecrest
