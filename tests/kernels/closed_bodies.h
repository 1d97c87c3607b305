// Closed rooms for the tests of leaks and self-intersection: whatever ray starts inside one must hit its walls.
//
// Corners are rounded to float first, as the vertices of a mesh are, so that all walls that meet in one agree on it.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/kernels/intersectors.h"

namespace wavecrest {

struct ClosedBody {
  std::vector<PrimitiveRecord<double>> walls;
  Point center{};
  double reach = 0;            // a cube of this half side around the centre lies inside
  std::vector<Point> corners;  // of polyhedra
  std::vector<std::array<size_t, 2>> edges;
  double size = 1;  // largest extent, for tolerances
};

inline Point roundedToFloat(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// The shell of the measured Cornell box, closed by a front wall. Its floor, ceiling, back, front and left wall are no
// parallelograms, so they are triangles; the right wall (x = 0) is a quad. All corners are shared.
inline ClosedBody cornellShell() {
  ClosedBody body{.walls = {}, .center = {276, 274, 279}, .reach = 270, .corners = {}, .edges = {}, .size = 559};
  const auto at = [](double x, double y, double z) { return roundedToFloat({x, y, z}); };
  const Point a = at(552.8, 0, 0), b = at(0, 0, 0), c = at(0, 0, 559.2), d = at(549.6, 0, 559.2);
  const Point e = at(556, 548.8, 0), f = at(556, 548.8, 559.2), g = at(0, 548.8, 559.2), h = at(0, 548.8, 0);
  const auto pair = [&](const Point& p, const Point& q, const Point& r, const Point& s) {
    body.walls.push_back(trianglePrimitive(p, q, r));
    body.walls.push_back(trianglePrimitive(p, r, s));
  };
  pair(a, b, c, d);  // floor
  pair(e, f, g, h);  // ceiling
  pair(d, c, g, f);  // back
  pair(a, d, f, e);  // left, bent
  pair(b, a, e, h);  // front
  body.walls.push_back(quadPrimitive(b, h, c));
  body.corners = {a, b, c, d, e, f, g, h};
  body.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4},
                {1, 7}, {2, 6}, {3, 5}, {0, 2}, {4, 6}, {3, 6}, {0, 5}, {1, 4}};  // the last five: diagonals
  return body;
}

// A turned cube of half side `half`, of six quads or of twelve triangles, normals inward.
inline ClosedBody turnedCube(double half, const Point& center, bool triangles) {
  ClosedBody body{.walls = {}, .center = center, .reach = half * 0.55, .corners = {}, .edges = {}, .size = 2 * half};
  for (size_t i = 0; i < 8; ++i) {
    const Point p{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
    body.corners.push_back(roundedToFloat(center + turned(p) * half));
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t bit = size_t{1} << axis, nextU = size_t{1} << (axis + 1) % 3, nextV = size_t{1} << (axis + 2) % 3;
    for (size_t i = 0; i < 8; ++i) {
      if ((i & bit) == 0) body.edges.push_back({i, i | bit});
    }
    for (const size_t side : {size_t{0}, bit}) {
      // u x v points along the axis: inward on the low side, turned around on the high side.
      const size_t u = side == 0 ? nextU : nextV, v = side == 0 ? nextV : nextU;
      const Point &p = body.corners[side], &alongU = body.corners[side | u], &alongV = body.corners[side | v];
      if (!triangles) {
        body.walls.push_back(quadPrimitive(p, alongU, alongV));
        continue;
      }
      body.walls.push_back(trianglePrimitive(p, alongU, alongV));
      body.walls.push_back(trianglePrimitive(body.corners[side | u | v], alongV, alongU));
      body.edges.push_back({side | u, side | v});
    }
  }
  return body;
}

inline ClosedBody hollowSphere(double radius, const Point& center) {
  return {.walls = {spherePrimitive(center, radius, -1)},
          .center = center,
          .reach = radius * 0.57,
          .corners = {},
          .edges = {},
          .size = 2 * radius};
}

// A sphere of two triangles to a cell of latitude and longitude, with bumps from every corner; closed.
inline ClosedBody bumpySphere(size_t rows, double bumps) {
  ClosedBody body{.walls = {}, .center = {0.3, -0.2, 0.1}, .reach = 0.3, .corners = {}, .edges = {}, .size = 2};
  const size_t columns = 2 * rows;
  RandomPoints random(3);
  for (size_t row = 0; row <= rows; ++row) {
    const double theta = std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows);
    for (size_t column = 0; column < columns; ++column) {
      const double phi = 2 * std::numbers::pi * static_cast<double>(column) / static_cast<double>(columns);
      const bool pole = row == 0 || row == rows;
      const Point p{pole ? 0 : std::sin(theta) * std::cos(phi), std::cos(theta),
                    pole ? 0 : std::sin(theta) * std::sin(phi)};
      const double size = pole ? 1 : 1 + random.uniform(-bumps, bumps);
      body.corners.push_back(roundedToFloat(body.center + turned(p) * size));
    }
  }
  const auto index = [&](size_t row, size_t column) { return row * columns + column % columns; };
  for (size_t row = 0; row < rows; ++row) {
    for (size_t column = 0; column < columns; ++column) {
      const size_t a = index(row, column), b = index(row, column + 1), c = index(row + 1, column + 1),
                   d = index(row + 1, column);
      const auto at = [&](size_t i) { return body.corners[i]; };
      if (row > 0) body.walls.push_back(trianglePrimitive(at(a), at(b), at(c)));
      if (row + 1 < rows) body.walls.push_back(trianglePrimitive(at(a), at(c), at(d)));
      if (row > 0) body.edges.push_back({a, b});
      body.edges.push_back({a, d});
      body.edges.push_back({a, c});
    }
  }
  return body;
}

// Quads, triangles and spheres anywhere in a cube, which is not closed.
inline std::vector<PrimitiveRecord<double>> crowd(size_t count) {
  RandomPoints random(9);
  std::vector<PrimitiveRecord<double>> list;
  for (size_t i = 0; i < count; ++i) {
    const Point p = random.inCube(1), e1 = random.direction() * random.uniform(0.01, 0.3);
    const Point e2 = normalized(cross(e1, random.direction())) * random.uniform(0.01, 0.3);
    if (i % 3 == 0) list.push_back(facePrimitive(PrimitiveKind::quad, p, e1, e2));
    if (i % 3 == 1) list.push_back(facePrimitive(PrimitiveKind::triangle, p, e1, e2));
    if (i % 3 == 2) list.push_back(spherePrimitive(p, random.uniform(0.01, 0.1)));
  }
  return list;
}

}  // namespace wavecrest
