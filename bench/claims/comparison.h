// Comparisons that conditions are judged by, and how their values are printed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/claims/judge_claims.h"
#include "bench/statistics/bands.h"

namespace wavecrest {

// margin: by how much it holds, below 0 by how much it does not, in logarithms or the metric's unit.
struct Comparison {
  ClaimVerdict verdict = ClaimVerdict::holds;
  double margin = 0;
  std::string text = {};
};

// Whether a value lies above, or below, a limit; undecided if the limit is within the band of the value.
Comparison above(const Band& band, double limit, std::string text);
Comparison below(const Band& band, double limit, std::string text);

// The comparison of the opposite question: a verdict that is decided turns round.
Comparison negated(Comparison c);

// Of several, at least one: those that hold come first, by how clearly they do; those that fail come last.
Comparison best(const std::vector<Comparison>& all);
Comparison worst(const std::vector<Comparison>& all);
// The comparison in the middle. It holds where more than half of all do.
Comparison middle(std::vector<Comparison> all);

// The geometric mean of numbers whose logarithms are given.
double meanOfLog(std::span<const double> logarithms);

// " ± 0.02"; nothing where no width is known, or where equal values have none.
std::string plusMinus(double halfWidth);

// "59.4 s", "1440 s": three digits, or all before the point.
std::string secondsText(double seconds);

// A metric in print.
std::string nameOf(const std::string& metric);

}  // namespace wavecrest
