#include "kernels/extend/corner_weld.h"

#include <algorithm>
#include <cmath>

#include "kernels/double_vectors.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Units of rounding of the reach: two quads' fourth corners at one vertex, and the rounding of both to float.
constexpr double kWeldUnits = 2 * kQuadUnits + 2;
// Whether a face is large enough to be welded: its shortest edge, in units of the tolerance.
constexpr double kLeastEdge = 64;
bool isLarge(double edge2, double tolerance) { return edge2 >= kLeastEdge * kLeastEdge * tolerance * tolerance; }

double toleranceOf(const PrimitiveRecord<double>& record) {
  return kWeldUnits * kUnitRoundoff * reachOf(vec(record.p0), vec(record.e1), vec(record.e2));
}

}  // namespace

double reachOf(const D3& p0, const D3& e1, const D3& e2) {
  double reach = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    reach = std::max(reach, std::abs(p0[axis]) + std::abs(e1[axis]) + std::abs(e2[axis]));
  }
  return reach;
}

double shortestEdge2(const PrimitiveRecord<double>& record) {
  const D3 e1 = vec(record.e1), e2 = vec(record.e2);
  return std::min({dot(e1, e1), dot(e2, e2), dot(e2 - e1, e2 - e1)});
}

Corner cornerAt(const PrimitiveRecord<double>& record, double u, double v) {
  Corner corner;
  for (size_t i = 0; i < 3; ++i) corner[i] = static_cast<float>(record.p0[i] + u * record.e1[i] + v * record.e2[i]);
  return corner;
}

CornerWeld::CornerWeld(const std::vector<PrimitiveRecord<double>>& quads) {
  std::vector<Point> all;
  for (const PrimitiveRecord<double>& quad : quads) {
    const double tolerance = toleranceOf(quad), edge2 = shortestEdge2(quad);
    if (!isLarge(edge2, tolerance)) continue;
    for (const double u : {0.0, 1.0}) {
      for (const double v : {0.0, 1.0}) all.push_back({cornerAt(quad, u, v), static_cast<float>(tolerance), edge2});
    }
    widest_ = std::max(widest_, static_cast<float>(tolerance));
  }
  std::sort(all.begin(), all.end(), [](const Point& a, const Point& b) { return a.corner < b.corner; });
  for (const Point& point : all) {
    if (find(point.corner, point.edge2) == nullptr) points_.push_back(point);
  }
}

const CornerWeld::Point* CornerWeld::find(const Corner& corner, double edge2) const {
  auto at = std::lower_bound(points_.begin(), points_.end(), corner[0] - widest_,
                             [](const Point& point, float x) { return point.corner[0] < x; });
  for (; at != points_.end() && at->corner[0] <= corner[0] + widest_; ++at) {
    bool near = isLarge(edge2, at->tolerance);
    for (size_t axis = 0; axis < 3; ++axis) {
      near = near && std::abs(at->corner[axis] - corner[axis]) <= at->tolerance;
    }
    if (near) return &*at;
  }
  return nullptr;
}

Corner CornerWeld::operator()(const Corner& corner, double edge2) const {
  const Point* const point = find(corner, edge2);
  return point == nullptr ? corner : point->corner;
}

}  // namespace wavecrest
