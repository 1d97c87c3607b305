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

/// A line for each series and each score that people ask times to, SSIM 0.9 (the study's measure of convergence) and
/// 0.95, Q_MOS 80 and 90: the render time from which on the mean curve has it, "yes" where its first snapshot does; for
/// one that does not end with it the time at the rate of its curve, with the ends of the 95 % interval, where it is
/// known (time_ahead.h; no high end: it may be more than 100 times the render time). near_floor: "yes" where the
/// reference's noise keeps curves from it.
std::string timesAsCsv(const ConvergenceReport& report);

}  // namespace wavecrest
