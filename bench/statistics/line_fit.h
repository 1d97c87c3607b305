// Lines through points by least squares.
#pragma once

#include <optional>
#include <span>

namespace wavecrest {

struct LinePoint {
  double x = 0, y = 0;
};

// y = meanY + slope (x - meanX)
struct LineFit {
  double points = 0;
  double meanX = 0, meanY = 0, slope = 0;
  double squaresX = 0;  // sum of squared distances from meanX
  double residual = 0;  // variance of the points about the line; 0 of two
};

// Nothing where the points do not have two different x.
std::optional<LineFit> lineThrough(std::span<const LinePoint> points);

}  // namespace wavecrest
