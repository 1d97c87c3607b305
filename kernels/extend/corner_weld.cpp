#include "kernels/extend/corner_weld.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "kernels/double_vectors.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Units of rounding of the reach: two quads' fourth corners at one vertex, and the rounding of both to float.
constexpr double kWeldUnits = 2 * kQuadUnits + 2;
// Whether a face is large enough to be welded: its shortest edge, in units of the tolerance.
constexpr double kLeastEdge = 64;
bool isLarge(double edge2, double tolerance) { return edge2 >= kLeastEdge * kLeastEdge * tolerance * tolerance; }
// Thickness of a slab, in units of the widest tolerance: few corners are so close to a side that both slabs are
// searched.
constexpr double kSlab = 8;

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
  for (const PrimitiveRecord<double>& quad : quads) {
    const auto tolerance = static_cast<float>(toleranceOf(quad));
    const double edge2 = shortestEdge2(quad);
    if (tolerance == 0 || !isLarge(edge2, double{tolerance})) continue;
    for (const double u : {0.0, 1.0}) {
      for (const double v : {0.0, 1.0}) {
        points_.push_back(
            {.corner = cornerAt(quad, u, v), .tolerance = tolerance, .edge2 = edge2, .slab = 0, .welds = false});
      }
    }
    widest_ = std::max(widest_, double{tolerance});
  }
  if (points_.empty()) return;
  slabsPerUnit_ = 1 / (kSlab * widest_);
  for (Point& point : points_) point.slab = slabOf(double{point.corner[0]});
  std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
    return std::tie(a.slab, a.corner[1], a.corner[2], a.corner[0]) <
           std::tie(b.slab, b.corner[1], b.corner[2], b.corner[0]);
  });
  // Of the corners at a vertex the first with the widest tolerance becomes the point, since it is near all others.
  std::vector<Point*> byTolerance;
  byTolerance.reserve(points_.size());
  for (Point& point : points_) byTolerance.push_back(&point);
  std::stable_sort(byTolerance.begin(), byTolerance.end(),
                   [](const Point* a, const Point* b) { return a->tolerance > b->tolerance; });
  for (Point* point : byTolerance) point->welds = find(point->corner, point->edge2) == nullptr;
  std::erase_if(points_, [](const Point& point) { return !point.welds; });
}

double CornerWeld::slabOf(double x) const { return std::floor(x * slabsPerUnit_); }

const CornerWeld::Point* CornerWeld::find(const Corner& corner, double edge2) const {
  if (points_.empty()) return nullptr;
  const Point* best = nullptr;
  const double x{corner[0]}, y{corner[1]};
  const auto search = [&](double slab) {
    auto at = std::lower_bound(points_.begin(), points_.end(), std::pair{slab, y - widest_},
                               [](const Point& point, const std::pair<double, double>& from) {
                                 return std::pair{point.slab, double{point.corner[1]}} < from;
                               });
    for (; at != points_.end() && at->slab == slab && double{at->corner[1]} <= y + widest_; ++at) {
      bool near = at->welds && isLarge(edge2, double{at->tolerance});
      for (size_t axis = 0; axis < 3; ++axis) {
        near = near && std::abs(at->corner[axis] - corner[axis]) <= at->tolerance;
      }
      if (near && (best == nullptr || at->tolerance > best->tolerance)) best = &*at;
    }
  };
  const double first = slabOf(x - widest_), last = slabOf(x + widest_);
  search(first);
  if (last != first) search(last);
  return best;
}

Corner CornerWeld::operator()(const Corner& corner, double edge2) const {
  const Point* const point = find(corner, edge2);
  return point == nullptr ? corner : point->corner;
}

}  // namespace wavecrest
