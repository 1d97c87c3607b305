// Warps: chi-square of the points against the density of each, and the corners of the unit square.
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/effort.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/sample_columns.h"
#include "tests/kernels/statistics.h"
#include "tests/kernels/warp_entries.h"

namespace wavecrest {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr size_t kWarped = effort(1 << 18, 1 << 14);

template <class T>
struct Points {
  std::vector<T> x, y, z, height;
};

template <class T>
Points<T> apply(Warp<T> warp, const std::vector<T>& u, const std::vector<T>& v, T parameter) {
  Points<T> points;
  for (auto* column : {&points.x, &points.y, &points.z, &points.height}) column->resize(u.size());
  warp(u.data(), v.data(), parameter, points.x.data(), points.y.data(), points.z.data(), points.height.data(),
       u.size());
  return points;
}

class WarpTest : public IsaTest {
 protected:
  template <class T>
  const WarpFunctions<T>& warps() {
    if constexpr (sizeof(T) == 4) {
      return entries<WarpEntries>().floats;
    } else {
      return entries<WarpEntries>().doubles;
    }
  }
  template <class T>
  Points<T> sample(Warp<T> warp, T parameter = 0) {
    const SampleColumns uniform = drawPaths({.kind = SamplerKind::independent, .seed = 11, .iteration = 0}, kWarped);
    return apply<T>(warp, {uniform[0].begin(), uniform[0].end()}, {uniform[1].begin(), uniform[1].end()}, parameter);
  }
};
WAVECREST_TEST_EVERY_ISA(WarpTest);

// ---- chi-square -----------------------------------------------------------------------------------------------------

// A rectangle of coordinates (s, t), cut into cells. `coordinates` maps a point to it; `density` is the density per
// unit of s and t, zero outside of the shape.
struct Grid {
  double sLow, sHigh, tLow, tHigh;
  std::function<std::pair<double, double>(double x, double y, double z)> coordinates;
  std::function<double(double s, double t)> density;
};

template <class T>
double deviations(const Points<T>& points, const Grid& grid) {
  constexpr size_t kCells = 24, kFine = 32;
  std::vector<size_t> counts(kCells * kCells);
  for (size_t i = 0; i < points.x.size(); ++i) {
    const auto [s, t] = grid.coordinates(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                                         static_cast<double>(points.z[i]));
    const auto cell = [](double a, double low, double high) {
      const double x = (a - low) / (high - low) * static_cast<double>(kCells);
      return static_cast<size_t>(std::clamp(x, 0.0, static_cast<double>(kCells - 1)));
    };
    ++counts[cell(t, grid.tLow, grid.tHigh) * kCells + cell(s, grid.sLow, grid.sHigh)];
  }
  // Expected counts by the midpoint rule.
  std::vector<double> expected(kCells * kCells);
  const double ds = (grid.sHigh - grid.sLow) / (kCells * kFine), dt = (grid.tHigh - grid.tLow) / (kCells * kFine);
  for (size_t j = 0; j < kCells * kFine; ++j) {
    for (size_t i = 0; i < kCells * kFine; ++i) {
      const double s = grid.sLow + (static_cast<double>(i) + 0.5) * ds;
      const double t = grid.tLow + (static_cast<double>(j) + 0.5) * dt;
      expected[j / kFine * kCells + i / kFine] += grid.density(s, t) * ds * dt * static_cast<double>(kWarped);
    }
  }
  return chiSquareDeviations(counts, expected);
}

// Cells in (z, azimuth): solid angle is dz dphi.
Grid aroundZ(double zLow, const std::function<double(double z)>& pdfW) {
  return {zLow,
          1,
          -kPi,
          kPi,
          [](double x, double y, double z) { return std::pair(z, std::atan2(y, x)); },
          [pdfW](double z, double) { return pdfW(z); }};
}

const auto kPlane = [](double x, double y, double) { return std::pair(x, y); };

template <class T>
void checkDistributions(const WarpFunctions<T>& warps, const std::function<Points<T>(Warp<T>, T)>& sample) {
  const Grid disc{-1, 1, -1, 1, kPlane, [](double x, double y) { return x * x + y * y < 1 ? 1 / kPi : 0.0; }};
  EXPECT_LT(std::abs(deviations(sample(warps.concentricDisc, 0), disc)), kMaxDeviations);
  EXPECT_LT(std::abs(deviations(sample(warps.cosineHemisphere, 0), aroundZ(0, [](double z) { return z / kPi; }))),
            kMaxDeviations);
  EXPECT_LT(std::abs(deviations(sample(warps.uniformSphere, 0), aroundZ(-1, [](double) { return 1 / (4 * kPi); }))),
            kMaxDeviations);
  const double cosMax = std::sqrt(1 - 0.3);
  const Grid cone = aroundZ(cosMax, [&](double) { return 1 / (2 * kPi * (1 - cosMax)); });
  EXPECT_LT(std::abs(deviations(sample(warps.uniformCone, T(0.3)), cone)), kMaxDeviations);
  const Grid triangle{0, 1, 0, 1, kPlane, [](double b, double c) { return b + c < 1 ? 2.0 : 0.0; }};
  EXPECT_LT(std::abs(deviations(sample(warps.uniformTriangle, 0), triangle)), kMaxDeviations);
}

TEST_P(WarpTest, floatPointsFollowTheirDensities) {
  checkDistributions<float>(warps<float>(), [&](Warp<float> warp, float p) { return sample<float>(warp, p); });
}
TEST_P(WarpTest, doublePointsFollowTheirDensities) {
  checkDistributions<double>(warps<double>(), [&](Warp<double> warp, double p) { return sample<double>(warp, p); });
}

// 1 - cos = 2 sin^2(theta / 2) in full precision, down to lights that fill 1e-12 of the sphere
template <class T>
void checkHeights(const std::function<Points<T>(T)>& sampleCone) {
  for (const double sin2 : {0.3, 1e-3, 1e-8, 1e-12}) {
    const double sinHalf = std::sin(std::asin(std::sqrt(sin2)) / 2), expected = 2 * sinHalf * sinHalf;
    EXPECT_NEAR(sampleCone(static_cast<T>(sin2)).height[0], expected, 4 * std::numeric_limits<T>::epsilon() * expected);
  }
}

TEST_P(WarpTest, conesAreAsHighAsTheirAngle) {
  checkHeights<float>([&](float sin2) { return sample<float>(warps<float>().uniformCone, sin2); });
  checkHeights<double>([&](double sin2) { return sample<double>(warps<double>().uniformCone, sin2); });
}

// ---- corners --------------------------------------------------------------------------------------------------------

// Every pair of the smallest, the middle and the largest numbers, and their neighbours.
template <class T>
std::pair<std::vector<T>, std::vector<T>> cornerNumbers() {
  const T step = T(0x1p-24);
  std::vector<T> u, v;
  const T values[] = {0, step, T(0.25), T(0.5) - step, T(0.5), T(0.5) + step, T(0.75), 1 - step};
  for (const T a : values) {
    for (const T b : values) {
      u.push_back(a);
      v.push_back(b);
    }
  }
  return {u, v};  // 64 pairs: whole blocks at every width
}

template <class T>
void checkCorners(const WarpFunctions<T>& warps) {
  const auto [u, v] = cornerNumbers<T>();
  const T epsilon = std::numeric_limits<T>::epsilon();
  for (const Warp<T> warp : {warps.cosineHemisphere, warps.uniformSphere, warps.uniformCone}) {
    const Points<T> points = apply<T>(warp, u, v, T(1e-8));
    for (size_t i = 0; i < u.size(); ++i) {
      const T length = std::hypot(points.x[i], points.y[i], points.z[i]);
      EXPECT_NEAR(length, 1, 3 * epsilon) << u[i] << ' ' << v[i];
    }
  }
  const Points<T> disc = apply<T>(warps.concentricDisc, u, v, 0);
  const Points<T> triangle = apply<T>(warps.uniformTriangle, u, v, 0);
  for (size_t i = 0; i < u.size(); ++i) {
    EXPECT_LE(std::hypot(disc.x[i], disc.y[i]), 1 + epsilon);
    if (u[i] == T(0.5) && v[i] == T(0.5)) {
      EXPECT_EQ(disc.x[i], 0);
      EXPECT_EQ(disc.y[i], 0);
    }
    EXPECT_TRUE(triangle.x[i] >= 0 && triangle.y[i] >= 0 && triangle.x[i] + triangle.y[i] <= 1);
  }
}

TEST_P(WarpTest, cornersStayOnTheShapes) {
  checkCorners<float>(warps<float>());
  checkCorners<double>(warps<double>());
}

// A far light must not collapse to its centre: the points keep the spread of the double version.
TEST_P(WarpTest, narrowConesKeepTheirDigits) {
  const Points<float> narrow = sample<float>(warps<float>().uniformCone, 1e-8f);
  const Points<double> exact = sample<double>(warps<double>().uniformCone, 1e-8);
  for (size_t i = 0; i < 1000; ++i) {
    EXPECT_NEAR(narrow.x[i], exact.x[i], 4e-11);
    EXPECT_NEAR(narrow.y[i], exact.y[i], 4e-11);
  }
}

}  // namespace
}  // namespace wavecrest
