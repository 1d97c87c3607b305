#include "bench/statistics/bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace wavecrest {

MeanEstimate meanOf(std::span<const double> values) {
  MeanEstimate sample;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) sample.mean += value / n;
  double squares = 0;
  for (const double value : values) squares += (value - sample.mean) * (value - sample.mean);
  sample.degreesOfFreedom = n - 1;
  sample.variance = n > 1 ? squares / (n - 1) / n : std::numeric_limits<double>::infinity();
  return sample;
}

MeanEstimate differenceOf(std::span<const double> a, std::span<const double> b) {
  const MeanEstimate x = meanOf(a), y = meanOf(b);
  MeanEstimate difference{.mean = x.mean - y.mean, .variance = x.variance + y.variance};
  if (difference.variance == 0 || std::isinf(difference.variance)) return difference;
  difference.degreesOfFreedom =
      difference.variance * difference.variance /
      (x.variance * x.variance / x.degreesOfFreedom + y.variance * y.variance / y.degreesOfFreedom);
  return difference;
}

double studentQuantile(double degreesOfFreedom) {
  static constexpr std::array kTable{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                     2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086};
  const double last = kTable.size();
  if (degreesOfFreedom > last) return 1.960 + (kTable.back() - 1.960) * last / degreesOfFreedom;  // to 0.5 %
  return kTable[static_cast<size_t>(std::max(degreesOfFreedom, 1.0)) - 1];
}

double studentTail(double t, int degreesOfFreedom) {
  const double angle = std::atan(std::abs(t) / std::sqrt(degreesOfFreedom)), cosine = std::cos(angle),
               sine = std::sin(angle);
  const bool odd = degreesOfFreedom % 2 != 0;
  // Odd: sin (cos + 2/3 cos^3 + 2 4 / (3 5) cos^5 ...); even: sin (1 + 1/2 cos^2 + 1 3 / (2 4) cos^4 ...).
  double term = odd ? sine * cosine : sine, sum = 0;
  for (int k = odd ? 1 : 0; k <= degreesOfFreedom - 2; k += 2) {
    sum += term;
    term *= cosine * cosine * (k + 1) / (k + 2);
  }
  const double within = odd ? (angle + sum) / (std::numbers::pi / 2) : sum;
  return std::max(1 - within, 0.0);
}

Band meanBand(std::span<const double> values) {
  const MeanEstimate sample = meanOf(values);
  return {sample.mean, std::sqrt(sample.variance) * studentQuantile(sample.degreesOfFreedom)};
}

Band differenceBand(std::span<const double> a, std::span<const double> b) {
  const MeanEstimate difference = differenceOf(a, b);
  const double error = std::sqrt(difference.variance);
  if (error == 0 || std::isinf(error)) return {difference.mean, error};
  return {difference.mean, error * studentQuantile(difference.degreesOfFreedom)};
}

}  // namespace wavecrest
