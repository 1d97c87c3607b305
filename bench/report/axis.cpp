#include "bench/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wavecrest {
namespace {

constexpr double kRoom = 0.04;         // empty share at each end
constexpr double kLeastDecades = 0.8;  // a span that holds at least two of the values 1, 2, 5

// A value in axis coordinates: its log10 on a logarithmic axis, else itself.
double toAxis(AxisScale scale, double value) { return scale == AxisScale::kLogarithmic ? std::log10(value) : value; }

// The step 1, 2 or 5 times a power of ten that cuts the span into about five pieces.
double niceStep(double span) {
  const double raw = span / 5;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    // The factor 0.999 forgives rounding in the power.
    if (factor * power >= raw * 0.999) return factor * power;
  }
  return 10 * power;
}

// An exponent in Unicode superscript digits.
std::string superscript(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

}  // namespace

Axis::Axis(AxisScale scale, double low, double high)
    : scale_(scale), start_(toAxis(scale, low)), end_(toAxis(scale, high)) {
  assert(std::isfinite(start_) && std::isfinite(end_) && start_ <= end_);
  // Widen a short span around its centre until it is readable, then add room at both ends.
  const double leastSpan = scale == AxisScale::kLogarithmic ? kLeastDecades : std::max(1e-3, 1e-3 * std::abs(end_));
  if (end_ - start_ < leastSpan) {
    const double centre = 0.5 * (start_ + end_);
    start_ = centre - 0.5 * leastSpan;
    end_ = centre + 0.5 * leastSpan;
  }
  const double room = kRoom * (end_ - start_);
  start_ -= room;
  end_ += room;
}

double Axis::position(double value) const { return (toAxis(scale_, value) - start_) / (end_ - start_); }

double Axis::low() const { return scale_ == AxisScale::kLogarithmic ? std::pow(10, start_) : start_; }

double Axis::high() const { return scale_ == AxisScale::kLogarithmic ? std::pow(10, end_) : end_; }

std::vector<AxisTick> Axis::ticks() const {
  return scale_ == AxisScale::kLogarithmic ? logarithmicTicks() : linearTicks();
}

std::vector<AxisTick> Axis::linearTicks() const {
  std::vector<AxisTick> ticks;
  // Multiples of the step, as adding it up would gather rounding errors.
  const double step = niceStep(end_ - start_);
  for (double k = std::ceil(start_ / step); k * step <= end_; ++k) ticks.push_back({k * step, tickLabel(k * step)});
  return ticks;
}

// A line at each multiple 1..9 of each power of ten. Powers of ten carry labels; on a short axis 2 and 5 do as well,
// and on a very long one only every second or third power.
std::vector<AxisTick> Axis::logarithmicTicks() const {
  std::vector<AxisTick> ticks;
  const double decades = end_ - start_;
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / 7)));
  const int last = static_cast<int>(std::floor(end_));
  for (int exponent = static_cast<int>(std::floor(start_)); exponent <= last; ++exponent) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10.0, exponent);
      if (position(value) < 0 || position(value) > 1) continue;
      const bool labelled = digit == 1 ? exponent % stride == 0 : decades < 2 && (digit == 2 || digit == 5);
      if (labelled || stride == 1) ticks.push_back({value, labelled ? tickLabel(value) : ""});
    }
  }
  return ticks;
}

std::string tickLabel(double value) {
  if (value == 0) return "0";
  // The 1e-9 keeps exact powers of ten from rounding into the decade below.
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
  if (exponent >= -4 && exponent <= 4) return fmt::format("{:.10g}", value);
  const double mantissa = value / std::pow(10.0, exponent);
  const std::string power = "10" + superscript(exponent);
  return std::abs(mantissa - 1) < 1e-9 ? power : fmt::format("{:.3g}·{}", mantissa, power);
}

}  // namespace wavecrest
