// How much better a sample of a method is than one of a baseline, and how much longer it takes: errors after equal
// numbers of samples per pixel, and overheads.
#pragma once

#include <optional>
#include <string>

#include "bench/report/factor_table.h"
#include "bench/report/report_data.h"

namespace wavecrest {

/// A method beside a baseline after equal numbers of samples per pixel.
struct EqualSamples {
  double samples = 0;          ///< per pixel: the largest number that both have
  Factor error;                ///< the baseline's error over the method's
  Factor overhead;             ///< the method's render time over the baseline's
  std::optional<Factor> gain;  ///< error over overhead; nothing where both are bounds
};

/// `metricIndex` is that of an error that falls as one over the samples, as relMSE does. Between snapshots the error is
/// a power of the samples, a straight line in the plots, and time is linear. Bounds where the method or the baseline
/// has more samples in its first snapshot than the other one at its end: it had a larger error and a shorter time
/// before. Nothing where one of them has no sample counts (images of other programs) or no error above zero.
std::optional<EqualSamples> equalSamples(const ReportSeries& series, const ReportSeries& baseline, size_t metricIndex);

/// A table for each baseline, of relMSE; empty where there is nothing to compare or the report is without relMSE.
std::string renderEqualSamples(const ConvergenceReport& report);

}  // namespace wavecrest
