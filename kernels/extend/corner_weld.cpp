#include "kernels/extend/corner_weld.h"

#include <algorithm>
#include <cmath>

#include "kernels/double_vectors.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Units of rounding of the largest coordinate: the three corners that make up the fourth are each off by half a unit in
// the last place, and so is what they are compared with (find_boxes.cpp, kSameCorner).
constexpr double kWeldUnits = 4;
constexpr double kLeastEdge = 64;  // shortest edge of a quad that is welded, in units of its tolerance

double toleranceOf(const PrimitiveRecord<double>& record) {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    reach = std::max(reach, std::abs(record.p0[axis]) + std::abs(record.e1[axis]) + std::abs(record.e2[axis]));
  }
  return kWeldUnits * kUnitRoundoff * reach;
}

}  // namespace

Corner cornerAt(const PrimitiveRecord<double>& record, double u, double v) {
  Corner corner;
  for (size_t i = 0; i < 3; ++i) corner[i] = static_cast<float>(record.p0[i] + u * record.e1[i] + v * record.e2[i]);
  return corner;
}

CornerWeld::CornerWeld(const std::vector<PrimitiveRecord<double>>& quads) {
  std::vector<Point> all;
  for (const PrimitiveRecord<double>& quad : quads) {
    const double tolerance = toleranceOf(quad);
    if (std::min(length(vec(quad.e1)), length(vec(quad.e2))) < kLeastEdge * tolerance) continue;
    for (const double u : {0.0, 1.0}) {
      for (const double v : {0.0, 1.0}) all.push_back({cornerAt(quad, u, v), static_cast<float>(tolerance)});
    }
    widest_ = std::max(widest_, static_cast<float>(tolerance));
  }
  std::sort(all.begin(), all.end(), [](const Point& a, const Point& b) { return a.corner < b.corner; });
  for (const Point& point : all) {
    if (find(point.corner) == nullptr) points_.push_back(point);
  }
}

const CornerWeld::Point* CornerWeld::find(const Corner& corner) const {
  auto at = std::lower_bound(points_.begin(), points_.end(), corner[0] - widest_,
                             [](const Point& point, float x) { return point.corner[0] < x; });
  for (; at != points_.end() && at->corner[0] <= corner[0] + widest_; ++at) {
    bool near = true;
    for (size_t axis = 0; axis < 3; ++axis) {
      near = near && std::abs(at->corner[axis] - corner[axis]) <= at->tolerance;
    }
    if (near) return &*at;
  }
  return nullptr;
}

Corner CornerWeld::operator()(const Corner& corner) const {
  const Point* const point = find(corner);
  return point == nullptr ? corner : point->corner;
}

}  // namespace wavecrest
