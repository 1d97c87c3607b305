// How much longer a method that has missed a target would need, by the slope of its own curve
// (bench/statistics/time_to_loss.h).
#pragma once

#include <optional>
#include <string>

#include "bench/report/report_data.h"
#include "bench/report/series_values.h"

namespace wavecrest {

/// Seconds after the end of the runs, with the ends of the 95 % interval.
struct TimeAhead {
  double seconds = 0;
  Range interval;  ///< high may be infinite
  double end = 0;  ///< of the runs, in seconds
};

/// Whether the reference's noise keeps curves from a target or bends them before it: an image without error would score
/// worse, or its loss is more than half of the target's (kNearFloor). floor: what it would score.
bool isNearFloor(const ReportMetric& metric, double target, std::optional<double> floor);

/// Nothing where the target was reached, no score of the metric is the best, a run has fewer than three snapshots in
/// that part or does not get better there, the target is more than 100 times the render time away, or near the score of
/// a perfect image against this reference, floor.
std::optional<TimeAhead> timeAhead(const ReportSeries& series, const ReportMetric& metric, size_t metricIndex,
                                   double target, std::optional<double> floor);

/// Whether the interval's end is beyond what a curve is followed to, so that it may take any time longer.
bool isOpen(const TimeAhead& ahead);

/// "about 9 s more (7 s to 14 s)"; "or longer" in place of a high end beyond 100 times the render time.
std::string formatTimeAhead(const TimeAhead& ahead);

}  // namespace wavecrest
