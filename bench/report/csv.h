// Every measurement of a report as comma-separated values, for other programs.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// A header line, then a line for each metric of each snapshot: scene, method, series, seed, snapshot, seconds,
/// iterations, metric, value. RFC 4180; numbers with all their digits, nothing where there is no number.
std::string measurementsAsCsv(const ConvergenceReport& report);

/// A line for each finding of the study, with its verdict, evidence and, if it has one of its own, explanation.
std::string claimsAsCsv(const ConvergenceReport& report);

/// A line for each series and metric: mean and extremes over seeds at the end, what the reference's own noise would
/// score, and the render time from which on the mean curve has the metric's target, where it has one and ends with it.
std::string summaryAsCsv(const ConvergenceReport& report);

}  // namespace wavecrest
