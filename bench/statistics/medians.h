// Medians of repeated measurements and how far to trust them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace wavecrest {

// The median; of an even count the mean of the middle two. values must not be empty.
double median(std::vector<double> values);

struct Interval {
  double low = 0, high = 0;
  double halfWidth() const { return 0.5 * (high - low); }
};

// A figure as it is reported: a median over repetitions with the interval that holds the true one at kIntervalLevel.
struct Estimate {
  double value = 0;
  Interval interval;
  // Half of the interval's width over the value; 0 for a value of 0.
  double relativeError() const { return value > 0 ? interval.halfWidth() / value : 0; }
};
constexpr double kIntervalLevel = 0.95;

// Interval of the median by the bootstrap: percentiles of the medians of kResamples resamples, drawn with fixed
// random numbers so that the same values give the same interval (Efron, Tibshirani 1993, chapter 13). It assumes
// independent values. Below six values a percentile interval is too narrow, and the extremes are returned.
Interval bootstrapMedian(std::span<const double> values);
constexpr uint32_t kResamples = 2000;

Estimate estimateMedian(std::span<const double> values);

// The median of repetitions made in several visits, between which time passes: the median of the visits' medians. A
// machine whose speed drifts moves all values of a visit together, so values of one visit are not independent, but
// visits are. The interval is between two of the sorted medians, as far from either end: the narrowest such pair that
// holds the true median with probability kIntervalLevel, whatever the distribution (Conover 1999, chapter 3.2). 95 %
// takes six visits at least; with fewer the interval is their range, and with one that of estimateMedian. No visit may
// be empty.
Estimate estimateMedianOfVisits(std::span<const std::vector<double>> visits);
constexpr size_t kVisitsForInterval = 6;

// Distance of the quartiles over the median: the spread of single values, which outliers do not move.
double relativeSpread(std::vector<double> values);

}  // namespace wavecrest
