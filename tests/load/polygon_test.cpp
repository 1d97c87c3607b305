// Faces of many corners cut into triangles.
#include "engine/load/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wavecrest {
namespace {

// Sum of the signed areas of the triangles, seen along z.
double areaOf(const std::vector<Float3>& corners, double& largest) {
  double sum = 0;
  largest = 0;
  for (const auto& [a, b, c] : cutPolygon(corners)) {
    const Float3 &p = corners[a], &q = corners[b], &r = corners[c];
    const double area = 0.5 * (double{q[0] - p[0]} * (r[1] - p[1]) - double{r[0] - p[0]} * (q[1] - p[1]));
    sum += area;
    largest = std::max(largest, std::abs(area));
    EXPECT_GE(area, 0) << "a triangle outside of the face";
  }
  return sum;
}

// Triangles that all face the same way and have the area of the polygon in sum cover it once, whichever corner is
// first.
void expectCovered(std::vector<Float3> corners, double area) {
  for (size_t first = 0; first < corners.size(); ++first) {
    double largest = 0;
    EXPECT_EQ(cutPolygon(corners).size(), corners.size() - 2);
    EXPECT_NEAR(areaOf(corners, largest), area, 1e-6 * area) << "first corner " << first;
    EXPECT_LE(largest, area);
    std::ranges::rotate(corners, corners.begin() + 1);
  }
}

TEST(Polygon, ConvexOneIsAFanEvenIfItIsBent) {
  const std::vector<Float3> corners = {{0, 0, 0}, {1, 0, 0.3f}, {1, 1, 0}, {0, 1, 0.3f}};
  EXPECT_EQ(cutPolygon(corners), (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, ArrowheadIsCovered) { expectCovered({{-1, -1, 0}, {0, 0, 0}, {1, -1, 0}, {0, 1, 0}}, 1); }

TEST(Polygon, ReflexCornerThatIsRepeatedIsCovered) {
  expectCovered({{-1, -1, 0}, {0, 0, 0}, {0, 0, 0}, {1, -1, 0}, {0, 1, 0}}, 1);
}

TEST(Polygon, ConvexOneWithARepeatedCornerIsAFan) {
  const std::vector<Float3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(cutPolygon(corners), (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
}

TEST(Polygon, ArrowIsCovered) {
  expectCovered({{-.2f, -1, 0}, {.2f, -1, 0}, {.2f, .2f, 0}, {.8f, .2f, 0}, {0, 1, 0}, {-.8f, .2f, 0}, {-.2f, .2f, 0}},
                0.4 * 1.2 + 0.8 * 0.8);
}

TEST(Polygon, CombOfCollinearTeethIsCovered) {
  std::vector<Float3> corners = {{0, -1, 0}, {10, -1, 0}};
  for (int i = 10; i > 0; --i) {
    const auto x = static_cast<float>(i);
    corners.insert(corners.end(), {{x, 1, 0}, {x - 0.5f, 1, 0}, {x - 0.5f, 0, 0}, {x - 1, 0, 0}});
  }
  expectCovered(corners, 10 + 5);
}

// A square with a square hole, as exporters write it: out along a bridge and back.
TEST(Polygon, HoleBehindABridgeStaysOpen) {
  expectCovered(
      {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}},
      8);
}

TEST(Polygon, SpiralIsCovered) {
  std::vector<Float3> outer, inner;
  double area = 0;
  for (int i = 0; i <= 40; ++i) {
    const double angle = i * 0.4, radius = 1 + 0.3 * angle;
    const auto at = [&](double r) {
      return Float3{static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 0};
    };
    outer.push_back(at(radius + 0.4));
    inner.push_back(at(radius));
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  for (size_t i = 0; i < outer.size(); ++i) {
    const Float3 &p = outer[i], &q = outer[(i + 1) % outer.size()];
    area += 0.5 * (double{p[0]} * q[1] - double{q[0]} * p[1]);
  }
  expectCovered(outer, area);
}

TEST(Polygon, TooManyConcaveCornersAreRefused) {
  std::vector<Float3> corners;
  for (size_t i = 0; i <= kMostConcaveCorners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / (kMostConcaveCorners + 1);
    const double radius = i % 2 == 0 ? 1 : 0.9;
    corners.push_back({static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)), 0});
  }
  EXPECT_TRUE(cutPolygon(corners).empty());
}

}  // namespace
}  // namespace wavecrest
