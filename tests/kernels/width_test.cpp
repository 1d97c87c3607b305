// No face is wider than it is: the share of rays that meet a small body before a large wall is the area that its
// corners enclose, seen from near and from afar, from the front and at 80 degrees.
//
// A margin of some units of rounding of the scene's size would show: at 6e-8 times the wall's 6 units, a side of 1e-4
// grows by 0.4 % for each unit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/effort.h"
#include "tests/kernels/intersectors.h"

namespace wavecrest {
namespace {

enum class WideBody { quad, triangles, box, openBox };

struct View {
  const char* name;
  WideBody body;
  double side, distance, tilt;  // of the eye from the body, and of the body in degrees
};

Point tilted(const Point& p, double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return {p[0], p[1] * std::cos(a) - p[2] * std::sin(a), p[1] * std::sin(a) + p[2] * std::cos(a)};
}

// Around the origin; boxes are open at the back. The first four corners are those of a flat body.
std::vector<Point> cornersOf(const View& view) {
  std::vector<Point> corners;
  const double h = view.side / 2;
  const bool flat = view.body == WideBody::quad || view.body == WideBody::triangles;
  for (const double z : {h, -h}) {
    if (flat && z < 0) break;
    for (const auto& [x, y] : {std::pair{-h, -h}, std::pair{h, -h}, std::pair{-h, h}, std::pair{h, h}}) {
      corners.push_back(tilted({x, y, flat ? 0 : z}, view.tilt));
    }
  }
  return corners;
}

std::vector<PrimitiveRecord<double>> sceneOf(const View& view) {
  const std::vector<Point> c = cornersOf(view);
  std::vector<PrimitiveRecord<double>> list;
  const auto quad = [&](size_t p, size_t u, size_t v) { list.push_back(quadPrimitive(c[p], c[u], c[v])); };
  switch (view.body) {
    case WideBody::quad:
      quad(0, 1, 2);
      break;
    case WideBody::triangles:
      list.push_back(trianglePrimitive(c[0], c[1], c[2]));
      list.push_back(trianglePrimitive(c[3], c[2], c[1]));
      break;
    case WideBody::box:
      quad(4, 6, 5);
      [[fallthrough]];
    case WideBody::openBox:
      quad(0, 1, 2);
      quad(0, 4, 1);
      quad(2, 3, 6);
      quad(0, 2, 4);
      quad(1, 5, 3);
  }
  list.push_back(quadPrimitive({-3, -3, -3}, {3, -3, -3}, {-3, 3, -3}));
  return list;
}

// The corners as the eye at (0, 0, distance) sees them in the plane z = 0.
std::vector<std::array<double, 2>> seenFrom(double distance, const std::vector<Point>& corners) {
  std::vector<std::array<double, 2>> seen;
  for (const Point& p : corners) {
    const double scale = distance / (distance - p[2]);
    seen.push_back({p[0] * scale, p[1] * scale});
  }
  return seen;
}

// Area of the convex hull (Andrew's monotone chain).
double hullArea(std::vector<std::array<double, 2>> points) {
  std::sort(points.begin(), points.end());
  double twiceArea = 0;
  for (int half = 0; half < 2; ++half) {
    std::vector<std::array<double, 2>> chain;
    for (const auto& p : points) {
      const auto turnsRight = [&] {
        const auto &a = chain[chain.size() - 2], &b = chain.back();
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0;
      };
      while (chain.size() >= 2 && turnsRight()) chain.pop_back();
      chain.push_back(p);
    }
    for (size_t i = 1; i < chain.size(); ++i)
      twiceArea += chain[i - 1][0] * chain[i][1] - chain[i][0] * chain[i - 1][1];
    std::reverse(points.begin(), points.end());
  }
  return twiceArea / 2;
}

class WidthTest : public testing::TestWithParam<std::tuple<Intersector, View>> {};

TEST_P(WidthTest, facesCoverTheirAreaAndNoMore) {
  const auto& [intersector, view] = GetParam();
  const StageScene<float> scene(sceneOf(view));
  const auto wall = static_cast<uint32_t>(scene.precise.size() - 1);
  const uint32_t wallIndex = view.body == WideBody::triangles ? 0 : wall;  // quads come first
  const auto seen = seenFrom(view.distance, cornersOf(view));
  double half[2] = {};
  for (const auto& p : seen) {
    for (size_t i = 0; i < 2; ++i) half[i] = std::max(half[i], 1.2 * std::abs(p[i]));
  }
  // One ray through a random point of each cell of a window around the body.
  constexpr size_t kCells = effort(512, 128);
  RandomPoints random(17);
  RayBatch batch;
  size_t hits = 0, misses = 0;
  for (size_t row = 0; row < kCells; ++row) {
    batch.clear();
    for (size_t column = 0; column < kCells; ++column) {
      const auto along = [&](size_t cell, double reach) {
        return reach * (2 * (static_cast<double>(cell) + random.uniform(0, 1)) / kCells - 1);
      };
      batch.push(aimedRay({0, 0, view.distance}, {along(column, half[0]), along(row, half[1]), 0}));
    }
    misses += batch.extend(intersector, scene.view);
    for (size_t i = 0; i < batch.wave.hits.size; ++i) hits += batch.wave.hits.primitive[i] != wallIndex ? 1 : 0;
  }
  EXPECT_EQ(misses, 0u);
  const double cell = 4 * half[0] * half[1] / (double{kCells} * kCells);
  const double area = hullArea(seen), error = static_cast<double>(hits) * cell / area - 1;
  // Five standard deviations: of 4 kCells cells on the edge, each is hit by chance, with a variance of 1/6 on average.
  const double noise = 5 * std::sqrt(4 * kCells / 6.0) * cell / area;
  EXPECT_LT(std::abs(error), noise);
  EXPECT_LT(noise, kFullSpeed ? 1e-3 : 1e-2) << "what is asked for";
}

constexpr View kViews[] = {{"quad", WideBody::quad, 1e-3, 4, 0},
                           {"tinyQuad", WideBody::quad, 1e-4, 4, 0},
                           {"tinyQuadNear", WideBody::quad, 1e-4, 0.5, 0},
                           {"tinyQuadFar", WideBody::quad, 1e-4, 400, 0},
                           {"tinyQuadTilted", WideBody::quad, 1e-4, 4, 80},
                           {"tinyTriangles", WideBody::triangles, 1e-4, 4, 0},
                           {"tinyTrianglesTilted", WideBody::triangles, 1e-4, 4, 80},
                           {"tinyBox", WideBody::box, 1e-4, 4, 0},
                           {"tinyBoxTilted", WideBody::box, 1e-4, 4, 80},
                           {"tinyOpenBox", WideBody::openBox, 1e-4, 4, 0},
                           {"tinyOpenBoxTilted", WideBody::openBox, 1e-4, 4, 80}};
INSTANTIATE_TEST_SUITE_P(Kernels, WidthTest,
                         testing::Combine(testing::ValuesIn(fastestIntersectors()), testing::ValuesIn(kViews)),
                         [](const auto& instance) {
                           return std::get<0>(instance.param).name + "_" + std::get<1>(instance.param).name;
                         });

}  // namespace
}  // namespace wavecrest
