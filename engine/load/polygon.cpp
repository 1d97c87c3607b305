#include "engine/load/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/scene/vector_math.h"

namespace wavecrest {

namespace {

struct Point {
  double x = 0, y = 0;
  bool operator==(const Point&) const = default;
};

// Twice the signed area of a triangle. Differences and products of floats are nearly exact in double.
double area2(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

double squaredDistance(const Point& a, const Point& b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }

// Two of the three coordinates: the face as seen along the third, counter-clockwise. That is the one closest to the
// mean normal (Newell's). Other directions would need rounding.
struct View {
  size_t x = 0, y = 1;

  explicit View(std::span<const Float3> corners) {
    Double3 normal{};
    const Double3 origin = widened(corners[0]);
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
      normal = normal + cross(widened(corners[i]) - origin, widened(corners[i + 1]) - origin);
    }
    size_t along = 0;
    for (size_t k = 1; k < 3; ++k) {
      if (std::abs(normal[k]) > std::abs(normal[along])) along = k;
    }
    x = (along + 1) % 3;
    y = (along + 2) % 3;
    if (normal[along] < 0) std::swap(x, y);
  }
  Point operator()(const Float3& corner) const { return {corner[x], corner[y]}; }
};

// But for what rounding makes of collinear corners. A corner that is repeated makes no turn: the edges on either side
// of it do.
bool isConvex(std::span<const Float3> corners, const View& view) {
  constexpr double kRounding = 1e-6;  // the sine of a turn
  // The last edge that has a length.
  const Point last = view(corners.back());
  Point a = last, b = last;
  for (size_t i = corners.size() - 1; i > 0 && a == b; --i) a = view(corners[i - 1]);
  for (const Float3& corner : corners) {
    const Point c = view(corner);
    if (c == b) continue;
    const double turn = area2(a, b, c);
    if (turn < 0 && turn * turn > kRounding * kRounding * squaredDistance(a, b) * squaredDistance(b, c)) return false;
    a = b;
    b = c;
  }
  return true;
}

// Cuts ears off a polygon (Meisters, "Polygons Have Ears", 1975): corners that are convex and whose triangle contains
// no other corner.
class EarClipper {
 public:
  EarClipper(std::span<const Float3> corners, const View& view)
      : next_(corners.size()), previous_(corners.size()), ear_(corners.size()) {
    for (const Float3& corner : corners) points_.push_back(view(corner));
    const auto count = static_cast<uint32_t>(corners.size());
    for (uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
  }

  std::vector<std::array<uint32_t, 3>> cut() {
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<uint32_t> left(points_.size());
    std::iota(left.begin(), left.end(), 0);
    for (const uint32_t i : left) ear_[i] = isEar(i, left);
    while (left.size() > 3) {
      const uint32_t i = bestEar(left), a = previous_[i], b = next_[i];
      triangles.push_back({a, i, b});
      std::erase(left, i);
      next_[a] = b;
      previous_[b] = a;
      for (const uint32_t neighbour : {a, b}) ear_[neighbour] = isEar(neighbour, left);
    }
    triangles.push_back({previous_[left[0]], left[0], next_[left[0]]});
    return triangles;
  }

 private:
  // The ear with the shortest cut, whichever corner comes first. Only a face that crosses itself may have none; then
  // the most convex corner.
  uint32_t bestEar(const std::vector<uint32_t>& left) const {
    const auto cutOf = [&](uint32_t i) { return squaredDistance(points_[previous_[i]], points_[next_[i]]); };
    uint32_t best = left[0];
    for (const uint32_t i : left) {
      if (ear_[i] != ear_[best] ? ear_[i] : ear_[i] ? cutOf(i) < cutOf(best) : turnAt(i) > turnAt(best)) best = i;
    }
    return best;
  }
  double turnAt(uint32_t i) const { return area2(points_[previous_[i]], points_[i], points_[next_[i]]); }

  bool isEar(uint32_t i, const std::vector<uint32_t>& left) const {
    const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
    if (!(area2(a, b, c) > 0)) return false;
    // Corners at the same place as one of these do not count: a face around a hole passes twice along a bridge.
    return std::ranges::none_of(left, [&](uint32_t other) {
      const Point& p = points_[other];
      return p != a && p != b && p != c && area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
    });
  }

  std::vector<Point> points_;
  std::vector<uint32_t> next_, previous_;  // around what is left of the face
  std::vector<char> ear_;
};

std::vector<std::array<uint32_t, 3>> fan(size_t corners) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 1; i + 1 < corners; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> cutPolygon(std::span<const Float3> corners) {
  if (corners.size() <= 3) return fan(corners.size());
  const View view(corners);
  if (isConvex(corners, view)) return fan(corners.size());
  if (corners.size() > kMostConcaveCorners) return {};
  return EarClipper(corners, view).cut();
}

std::string tooManyCorners(size_t corners) {
  return "concave face has " + std::to_string(corners) + " corners; expected at most " +
         std::to_string(kMostConcaveCorners);
}

}  // namespace wavecrest
