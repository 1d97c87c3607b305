// How many times faster methods are than a baseline at equal error, scene by scene and in the geometric mean.
#pragma once

#include <optional>
#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// The baseline's render time over the method's, to the larger of their errors at the end: the one that both reach.
struct SpeedUp {
  double factor = 0;
  /// -1: no more than that, as the first snapshot of the baseline has that error already; 1: no less; 0: neither.
  int bound = 0;
};

/// Nothing where one of them has no score.
std::optional<SpeedUp> speedUp(const ReportSeries& series, const ReportSeries& baseline, const ReportMetric& metric,
                               size_t metricIndex);

/// A table for each baseline, of which the report's own is open (path tracing where it names none); empty where there
/// is nothing to compare.
std::string renderSpeedUps(const ConvergenceReport& report);

}  // namespace wavecrest
