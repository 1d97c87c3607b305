// Every measurement of a report as comma-separated values, for other programs.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// A header line, then a line for each metric of each snapshot: scene, method, series, seed, snapshot, seconds,
/// iterations, metric, value. RFC 4180; numbers with all their digits, nothing where there is no number.
std::string measurementsAsCsv(const ConvergenceReport& report);

}  // namespace wavecrest
