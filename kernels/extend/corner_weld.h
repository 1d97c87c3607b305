// Corners of quads that rounding has moved apart, made one again.
//
// A quad keeps three corners; the fourth, p0 + e1 + e2, may miss the vertex of a mesh that it was before two triangles
// became the quad by some units of rounding. Triangle tests are watertight where neighbours agree on their corners to
// the bit (bvh_lanes.h), so every corner that lies that close to one of a quad is replaced by the same point.
#pragma once

#include <array>
#include <vector>

#include "kernels/scene_view.h"

namespace wavecrest {

using Corner = std::array<float, 3>;

class CornerWeld {
 public:
  // quads: those of the scene. Quads that are hardly larger than what is welded are left out.
  explicit CornerWeld(const std::vector<PrimitiveRecord<double>>& quads);
  // The point that takes the place of a corner of any face. edge2: the face's shortestEdge2. A face that is hardly
  // larger than what a point welds keeps its corner there.
  Corner operator()(const Corner& corner, double edge2) const;

 private:
  struct Point {
    Corner corner;
    float tolerance;  // greatest distance along an axis of what becomes this point
    double edge2;     // of its quad
    double slab;      // number of the slab of space along x that the corner is in
    bool welds;       // it takes the place of others; while the list is made some corners do not
  };
  // Of the points that take the corner, the one of the widest tolerance, or nullptr.
  const Point* find(const Corner& corner, double edge2) const;
  double slabOf(double x) const;

  std::vector<Point> points_;  // sorted by slab, then by y: many may lie in one plane across x
  double widest_ = 0;          // greatest tolerance
  double slabsPerUnit_ = 0;
};

// A corner of a quad or triangle before it is welded.
Corner cornerAt(const PrimitiveRecord<double>& record, double u, double v);
// The square of the shortest of e1, e2 and e2 - e1.
double shortestEdge2(const PrimitiveRecord<double>& record);

// Bounds the coordinates of a quad's corners: the greatest sum of |p0|, |e1| and |e2| along an axis.
double reachOf(const std::array<double, 3>& p0, const std::array<double, 3>& e1, const std::array<double, 3>& e2);
// How far the fourth corner of a quad may lie off the vertex that it stands for, in units of rounding of the reach.
constexpr double kQuadUnits = 2;

}  // namespace wavecrest
