// A plot axis, logarithmic or linear: which range to show, where a value falls in it, and where ticks go.
#pragma once

#include <string>
#include <vector>

namespace wavecrest {

enum class AxisScale { kLinear, kLogarithmic };

struct AxisTick {
  double value;
  std::string label;  ///< empty: minor grid line
};

class Axis {
 public:
  /// Covers [low, high] with a little room at both ends, and never less than a readable span. A logarithmic axis needs
  /// 0 < low; values must be finite.
  Axis(AxisScale scale, double low, double high);

  /// 0 at the lower end of the axis, 1 at the upper end.
  double position(double value) const;
  double low() const;
  double high() const;
  std::vector<AxisTick> ticks() const;

 private:
  std::vector<AxisTick> linearTicks() const;
  std::vector<AxisTick> logarithmicTicks() const;

  AxisScale scale_;
  double start_, end_;  // in axis coordinates: log10 of the value, or the value
};

/// 0.002, 5, 3000, and beyond five digits a power: "10⁻⁶", "2·10⁷".
std::string tickLabel(double value);

}  // namespace wavecrest
