// When a loss that falls with time will be that small, by the slope of its own curve.
//
// A score's loss, its distance from the best possible one, falls about as a power of time: a straight line in the
// logarithms of both. It is fitted to the last part of each run, from a quarter of its time on, and followed to the
// loss that is wanted.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/statistics/bands.h"

namespace wavecrest {

// A line is not followed farther than so many times the time that it was fitted to.
constexpr double kFarthestTime = 100;

// Nor to a loss below so many times that of an image without error: there the reference's noise is much of what is
// measured, and the curve is flatter than the line.
constexpr double kNearFloor = 2;

// A snapshot. Those of a run are in order of time.
struct LossPoint {
  double seconds = 0, loss = 0;
};

// Bounds and band are 95 % intervals over the seeds; with one seed they are those of its fitted line. Curves also bend,
// so the logarithms of the bounds are at least 0.75 times as far from the time as that is from the end of the runs: of
// lines through the first half, quarter or tenth of the published runs (bench/campaign), followed to their ends, 98 of
// 100 arrive within the bounds in SSIM, 91 in Q_MOS.
struct TimeToLoss {
  double seconds = 0;        // from the start of the run; it may be before its end, where the last points are above the
                             // line
  double low = 0, high = 0;  // high may be infinite
  Band slope = {};           // d log(loss) / d log(time)
};

// Nothing where there is no run, or where one has fewer than three snapshots in its last part or does not get better
// there.
std::optional<TimeToLoss> timeToLoss(std::span<const std::vector<LossPoint>> runs, double loss);

// With two significant digits: more would promise too much of a time that was not measured.
double roundedTime(double seconds);

}  // namespace wavecrest
