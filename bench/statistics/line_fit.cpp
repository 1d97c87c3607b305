#include "bench/statistics/line_fit.h"

namespace wavecrest {

std::optional<LineFit> lineThrough(std::span<const LinePoint> points) {
  if (points.size() < 2) return std::nullopt;
  LineFit line{.points = static_cast<double>(points.size())};
  // Counted from the first point, so that the mean of equal x is that x, without rounding.
  for (const LinePoint& point : points) {
    line.meanX += (point.x - points.front().x) / line.points;
    line.meanY += point.y / line.points;
  }
  line.meanX += points.front().x;
  double product = 0;
  for (const LinePoint& point : points) {
    line.squaresX += (point.x - line.meanX) * (point.x - line.meanX);
    product += (point.x - line.meanX) * (point.y - line.meanY);
  }
  if (!(line.squaresX > 0)) return std::nullopt;
  line.slope = product / line.squaresX;
  if (points.size() == 2) return line;
  for (const LinePoint& point : points) {
    const double off = point.y - line.meanY - line.slope * (point.x - line.meanX);
    line.residual += off * off / (line.points - 2);
  }
  return line;
}

}  // namespace wavecrest
