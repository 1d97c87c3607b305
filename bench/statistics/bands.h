// Values with bands from a few seeds: mean, and the half width of its 95 % confidence interval (Student's t; of
// differences Welch's, 1947). One value alone has no band.
#pragma once

#include <span>

namespace wavecrest {

// A mean of independent values, or a difference of two means, and how well it is known.
struct MeanEstimate {
  double mean = 0;
  double variance = 0;          // of the mean; infinite for one value alone
  double degreesOfFreedom = 1;  // of Student's distribution
};
MeanEstimate meanOf(std::span<const double> values);
// mean(a) - mean(b), with Welch's degrees of freedom; 1 where there is no variance.
MeanEstimate differenceOf(std::span<const double> a, std::span<const double> b);

struct Band {
  double mean = 0;
  double halfWidth = 0;  // infinite where there is none
};

// Two-sided 95 % quantile of Student's distribution; degrees of freedom are rounded down, to 1 at least.
double studentQuantile(double degreesOfFreedom);

// The probability that Student's t of a whole number of degrees of freedom is at least as far from 0 as t (Abramowitz,
// Stegun 1964, 26.7.3 and 26.7.4).
double studentTail(double t, int degreesOfFreedom);

// Seeds from which the share of squared bias in an error is told. It comes from pairs of seeds: two have one, and its
// error is as large as itself.
constexpr unsigned kFewestSeedsForShare = 4;

Band meanBand(std::span<const double> values);
// mean(a) - mean(b).
Band differenceBand(std::span<const double> a, std::span<const double> b);

}  // namespace wavecrest
