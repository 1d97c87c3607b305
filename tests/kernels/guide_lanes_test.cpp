// Directions as places in a square, directions drawn from histograms, and cells, against scalar arithmetic in double.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/kernels/guide_entries.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

class GuideLanesTest : public IsaTest {};

constexpr size_t kDirections = 1 << 16;

struct Directions {
  alignas(64) std::array<float, kDirections> x, y, z;
};

// Uniform on the sphere, and the directions of the axes and diagonals.
const Directions& sphereDirections() {
  static const Directions directions = [] {
    Directions out;
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (size_t i = 0; i < kDirections; ++i) {
      std::array<double, 3> d{normal(random), normal(random), normal(random)};
      const size_t column = i % 3, row = i / 3 % 3, layer = i / 9;
      if (i < 27 && i != 13) d = {double(column) - 1, double(row) - 1, double(layer) - 1};
      const double length = std::hypot(d[0], d[1], d[2]);
      out.x[i] = static_cast<float>(d[0] / length);
      out.y[i] = static_cast<float>(d[1] / length);
      out.z[i] = static_cast<float>(d[2] / length);
    }
    return out;
  }();
  return directions;
}

// The bin of a direction, by the definition of the fold.
uint32_t binOfDirection(double x, double y, double z) {
  const double norm = std::abs(x) + std::abs(y) + std::abs(z);
  double u = x / norm, v = y / norm;
  if (z < 0) {
    const double foldedU = std::copysign(1 - std::abs(v), u);
    v = std::copysign(1 - std::abs(u), v);
    u = foldedU;
  }
  const auto coordinate = [](double a) {
    return static_cast<uint32_t>(std::min(std::max((a + 1) / 2 * kGuideSide, 0.0), kGuideSide - 1.0));
  };
  return coordinate(u) + kGuideSide * coordinate(v);
}

TEST_P(GuideLanesTest, binsAreThoseOfTheFoldedOctahedron) {
  const Directions& d = sphereDirections();
  alignas(64) static std::array<uint32_t, kDirections> bins;
  alignas(64) static std::array<float, kDirections> solidAngles;
  entries<GuideEntries>().toSquare(d.x.data(), d.y.data(), d.z.data(), kDirections, bins.data(), solidAngles.data());
  size_t different = 0;
  double area = 0;
  for (size_t i = 0; i < kDirections; ++i) {
    different += bins[i] != binOfDirection(double{d.x[i]}, double{d.y[i]}, double{d.z[i]}) ? 1 : 0;
    ASSERT_LT(bins[i], kGuideBins);
    const double norm = std::abs(double{d.x[i]}) + std::abs(double{d.y[i]}) + std::abs(double{d.z[i]});
    EXPECT_NEAR(solidAngles[i] / (norm * norm * norm), 1, 1e-6);
    area += 4 * std::numbers::pi / double{solidAngles[i]} / kDirections;
  }
  EXPECT_LE(different, 16u) << "but for directions on a border of bins, which rounding decides";
  // The square has an area of 4. Standard deviation of 1 / solid angle over the sphere is below 0.2.
  EXPECT_NEAR(area, 4, 5 * 4 * std::numbers::pi * 0.2 / std::sqrt(double{kDirections}));
}

TEST_P(GuideLanesTest, drawsWhatItSaysWithTheDensityItSays) {
  // Two bins have all, one three times as much as the other: column 5 is filled up by bin 200.
  constexpr uint32_t kAll = 1u << kGuideUnitBits;
  std::vector<uint32_t> words(kGuideBins, GuideBin{.units = 0, .own = 0, .other = 200}.word());
  for (uint32_t column = 64; column < 127; ++column) words[column] = GuideBin{.units = 0, .own = 0, .other = 5}.word();
  words[5] = GuideBin{.units = kAll / 4, .own = 0, .other = 5}.word();
  words[200] = GuideBin{.units = kAll / 4 * 3, .own = 0, .other = 200}.word();
  const GuideView guide{.share = nullptr, .bins = words.data()};
  constexpr size_t kDraws = 1 << 14;
  alignas(64) static std::array<float, kDraws> b, c, d, x, y, z, pdf;
  std::mt19937 random(3);
  for (size_t i = 0; i < kDraws; ++i) {
    b[i] = static_cast<float>(i) / kDraws;
    c[i] = static_cast<float>(random() >> 8) * 0x1p-24f;
    d[i] = static_cast<float>(random() >> 8) * 0x1p-24f;
  }
  entries<GuideEntries>().draw(guide, b.data(), c.data(), d.data(), kDraws, x.data(), y.data(), z.data(), pdf.data());
  size_t first = 0, outside = 0;
  for (size_t i = 0; i < kDraws; ++i) {
    EXPECT_NEAR(std::hypot(x[i], y[i], z[i]), 1, 1e-6);
    const uint32_t bin = binOfDirection(double{x[i]}, double{y[i]}, double{z[i]});
    first += bin == 5 ? 1 : 0;
    outside += bin != 5 && bin != 200 ? 1 : 0;
    if (bin != 5 && bin != 200) continue;
    const double norm = std::abs(double{x[i]}) + std::abs(double{y[i]}) + std::abs(double{z[i]});
    const double density = (bin == 5 ? 0.25 : 0.75) * kGuideBins / 4;
    EXPECT_NEAR(double{pdf[i]} * norm * norm * norm / density, 1, 1e-5);
  }
  EXPECT_EQ(first, kDraws / 4);
  EXPECT_LE(outside, 4u) << "but for directions on a border, which rounding decides";
}

TEST_P(GuideLanesTest, findsTheCellOfAPlace) {
  // The root for +y (node 2) is split along x into nodes 6 and 7, node 7 along y into 8 and 9, and node 8 along z into
  // 10 and 11.
  const std::vector<uint32_t> nodes{
      kCellLeaf,     kCellLeaf | 1, 6, kCellLeaf | 3, kCellLeaf | 4, kCellLeaf | 5, kCellLeaf | 2, 8, 10, kCellLeaf | 6,
      kCellLeaf | 7, kCellLeaf | 8};
  std::vector<uint32_t> starts(kCellStarts);
  fillCellStarts(nodes.data(), starts.data());
  CellTreeView tree{.nodes = nodes.data(), .starts = starts.data(), .least = {-1, 0, -1}, .scale = {512, 512, 512}};
  constexpr size_t kPlaces = 16;
  alignas(64) std::array<float, kPlaces> x{}, y{}, z{};
  std::array<uint32_t, kPlaces> expected{};
  const auto set = [&](size_t i, float px, float py, float pz, uint32_t cell) {
    x[i] = px;
    y[i] = py;
    z[i] = pz;
    expected[i] = cell;
  };
  for (size_t i = 0; i < kPlaces; ++i) set(i, -0.5f, 0.5f, 0, 2);
  set(1, 0.5f, 0.5f, 0.5f, 8);
  set(2, 9, 0.5f, 9, 8);  // outside of the box, as on its border
  set(3, -9, 0.5f, 0.5f, 2);
  set(4, 0.5f, -0.5f, 0.5f, 3);
  set(5, 0.5f, 0.5f, -0.5f, 7);
  set(6, 0.5f, 1.5f, -0.5f, 6);
  alignas(64) std::array<uint32_t, kPlaces> cells{};
  entries<GuideEntries>().cells(tree, x.data(), y.data(), z.data(), kPlaces, cells.data());
  EXPECT_EQ(cells, expected);
}

WAVECREST_TEST_EVERY_ISA(GuideLanesTest);

}  // namespace
}  // namespace wavecrest
