#include "scenes/generate/lathe.h"

#include <algorithm>
#include <numbers>

namespace wavecrest::generate {
namespace {

using Point = std::array<double, 2>;

Point combine(double a, const Point& p, double b, const Point& q) { return {a * p[0] + b * q[0], a * p[1] + b * q[1]}; }

double knotInterval(const Point& a, const Point& b) { return std::sqrt(std::hypot(b[0] - a[0], b[1] - a[1])); }

// Position on the Catmull-Rom span p1-p2 at fraction f by the Barry-Goldman pyramid.
Point spanPoint(const Point& p0, const Point& p1, const Point& p2, const Point& p3, double f) {
  const double t1 = knotInterval(p0, p1), t2 = t1 + knotInterval(p1, p2), t3 = t2 + knotInterval(p2, p3);
  const double t = std::lerp(t1, t2, f);
  const Point a1 = combine((t1 - t) / t1, p0, t / t1, p1);
  const Point a2 = combine((t2 - t) / (t2 - t1), p1, (t - t1) / (t2 - t1), p2);
  const Point a3 = combine((t3 - t) / (t3 - t2), p2, (t - t2) / (t3 - t2), p3);
  const Point b1 = combine((t2 - t) / t2, a1, t / t2, a2);
  const Point b2 = combine((t3 - t) / (t3 - t1), a2, (t - t1) / (t3 - t1), a3);
  return combine((t2 - t) / (t2 - t1), b1, (t - t1) / (t2 - t1), b2);
}

// The point before the first (or after the last): mirrored in the axis if that one lies on it, else continued straight.
Point beyond(const Point& end, const Point& inner) {
  return end[0] == 0 ? Point{-inner[0], inner[1]} : Point{2 * end[0] - inner[0], 2 * end[1] - inner[1]};
}

}  // namespace

std::vector<ProfilePoint> smoothProfile(std::span<const Point> points, int steps) {
  std::vector<Point> controls{beyond(points[0], points[1])};
  controls.insert(controls.end(), points.begin(), points.end());
  controls.push_back(beyond(points[points.size() - 1], points[points.size() - 2]));

  std::vector<ProfilePoint> profile;
  const auto evaluate = [&](size_t span, double f) {
    return spanPoint(controls[span], controls[span + 1], controls[span + 2], controls[span + 3], f);
  };
  const auto add = [&](size_t span, double f) {
    constexpr double kStep = 1e-4;  // central difference for the tangent; spans are smooth beyond their ends
    const Point position = evaluate(span, f);
    const Point before = evaluate(span, f - kStep), after = evaluate(span, f + kStep);
    const double dr = after[0] - before[0], dh = after[1] - before[1], size = std::hypot(dr, dh);
    profile.push_back({std::max(position[0], 0.0), position[1], dh / size, -dr / size});
  };
  for (size_t span = 0; span + 1 < points.size(); ++span)
    for (int i = 0; i < steps; ++i) add(span, static_cast<double>(i) / steps);
  add(points.size() - 2, 1);
  for (size_t end : {size_t{0}, points.size() - 1}) {
    ProfilePoint& point = end == 0 ? profile.front() : profile.back();
    if (points[end][0] == 0) point = {0, points[end][1], 0, point.normalHeight < 0 ? -1.0 : 1.0};
  }
  return profile;
}

void appendLathe(Mesh& mesh, std::span<const ProfilePoint> profile, uint32_t segments) {
  const auto ringSize = [&](const ProfilePoint& point) { return point.radius == 0 ? 1u : segments; };
  const auto addRing = [&](const ProfilePoint& point) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t i = 0; i < ringSize(point); ++i) {
      // Decreasing angle: with the profile going up, quads between rings then face outwards.
      const double angle = -2 * std::numbers::pi * i / segments, c = std::cos(angle), s = std::sin(angle);
      mesh.addVertex({point.radius * c, point.height, point.radius * s},
                     {point.normalRadius * c, point.normalHeight, point.normalRadius * s});
    }
    return first;
  };
  uint32_t ring = addRing(profile[0]);
  for (size_t i = 1; i < profile.size(); ++i) {
    const uint32_t nextRing = addRing(profile[i]);
    const uint32_t size = ringSize(profile[i - 1]), nextSize = ringSize(profile[i]);
    if (size == segments && nextSize == segments) bridgeRings(mesh, ring, nextRing, segments);
    for (uint32_t k = 0; k < segments; ++k) {
      const uint32_t j = (k + 1) % segments;
      if (size == 1) mesh.addTriangle(ring, nextRing + j, nextRing + k);
      if (nextSize == 1) mesh.addTriangle(ring + k, ring + j, nextRing);
    }
    ring = nextRing;
  }
}

Mesh makeCone(double lowerRadius, double upperRadius, double height, uint32_t segments) {
  const double slope = upperRadius - lowerRadius, size = std::hypot(slope, height);
  const ProfilePoint profile[] = {{lowerRadius, 0, height / size, -slope / size},
                                  {upperRadius, height, height / size, -slope / size}};
  Mesh mesh;
  appendLathe(mesh, profile, segments);
  return mesh;
}

}  // namespace wavecrest::generate
