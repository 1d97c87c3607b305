// Textures at points: values and slopes of the bilinear patch, against the same in double.
#include "tests/kernels/texture_entries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

constexpr size_t kPoints = TextureEntries::kMost;

// A grey bitmap that repeats, unless record.wrap says otherwise.
struct GreyBitmap {
  TextureRecord record{};
  std::vector<float> texels;

  GreyBitmap(uint32_t width, uint32_t height, const std::array<float, 6>& toUv) {
    record.kind = static_cast<uint32_t>(TextureKind::bitmap);
    record.width = width;
    record.height = height;
    record.wrap = static_cast<uint32_t>(WrapMode::repeat);
    std::copy(toUv.begin(), toUv.end(), record.toUv);
    texels.resize(size_t{3} * width * height);
  }
  float& at(uint32_t x, uint32_t y) { return texels[3 * (size_t{y} * record.width + x)]; }
  double wrapped(double x, double y) const {
    // A mirrored bitmap goes back after its last texel, which comes twice.
    const auto inside = [&](double a, uint32_t size) {
      if (record.wrap == static_cast<uint32_t>(WrapMode::clamp)) {
        return static_cast<size_t>(std::clamp(a, 0.0, size - 1.0));
      }
      const double period = record.wrap == static_cast<uint32_t>(WrapMode::mirror) ? 2.0 * size : size;
      const double within = a - std::floor(a / period) * period;
      return static_cast<size_t>(within < size ? within : period - 1 - within);
    };
    return texels[3 * (inside(y, record.height) * record.width + inside(x, record.width))];
  }

  struct Patch {
    double value, slopeU, slopeV;
    double edge;  // distance in texels from the nearest edge between two patches
  };
  Patch patch(double u, double v) const {
    const float* m = record.toUv;
    const double x = (m[0] * u + m[1] * v + m[2]) * record.width - 0.5;
    const double y = (m[3] * u + m[4] * v + m[5]) * record.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    const double a = wrapped(x0, y0), b = wrapped(x0 + 1, y0), c = wrapped(x0, y0 + 1), d = wrapped(x0 + 1, y0 + 1);
    const double byX = (1 - fy) * (b - a) + fy * (d - c), byY = (1 - fx) * (c - a) + fx * (d - b);
    return {.value = (1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d),
            .slopeU = byX * record.width * m[0] + byY * record.height * m[3],
            .slopeV = byX * record.width * m[1] + byY * record.height * m[4],
            .edge = std::min({fx, 1 - fx, fy, 1 - fy})};
  }
};

class TextureTest : public IsaTest {
 protected:
  struct Points {
    float u[kPoints], v[kPoints], value[kPoints], slopeU[kPoints], slopeV[kPoints];
  };
  Points evaluate(const GreyBitmap& bitmap, std::mt19937& random, float range) const {
    std::uniform_real_distribution<float> uniform(-range, range);
    Points points;
    for (size_t i = 0; i < kPoints; ++i) {
      points.u[i] = uniform(random);
      points.v[i] = uniform(random);
    }
    entries<TextureEntries>().evaluate(&bitmap.record, bitmap.texels.data(), 0, points.u, points.v, points.value,
                                       points.slopeU, points.slopeV);
    return points;
  }
};
WAVECREST_TEST_EVERY_ISA(TextureTest);

TEST_P(TextureTest, slopesAreThoseOfTheBilinearPatch) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform;
  GreyBitmap bitmap(7, 5, {1.5f, -0.5f, 0.25f, 0.75f, 2, -0.125f});
  for (uint32_t y = 0; y < 5; ++y) {
    for (uint32_t x = 0; x < 7; ++x) bitmap.at(x, y) = uniform(random);
  }
  for (const WrapMode wrap : {WrapMode::repeat, WrapMode::mirror, WrapMode::clamp}) {
    bitmap.record.wrap = static_cast<uint32_t>(wrap);
    for (int round = 0; round < 50; ++round) {
      const Points points = evaluate(bitmap, random, 3);
      for (size_t i = 0; i < kPoints; ++i) {
        const GreyBitmap::Patch want = bitmap.patch(points.u[i], points.v[i]);
        if (want.edge < 1e-3) continue;  // float may be on the other side
        ASSERT_NEAR(points.value[i], want.value, 1e-4) << "wrap mode " << bitmap.record.wrap;
        ASSERT_NEAR(points.slopeU[i], want.slopeU, 1e-2) << "wrap mode " << bitmap.record.wrap;
        ASSERT_NEAR(points.slopeV[i], want.slopeV, 1e-2) << "wrap mode " << bitmap.record.wrap;
      }
    }
  }
}

// Forty thousand texels in a unit of u: no step in u is within a texel and above float's rounding everywhere.
TEST_P(TextureTest, slopesOfManyTilesOfAFineBitmap) {
  std::mt19937 random(4);
  GreyBitmap bitmap(2048, 2, {20, 0, 0, 0, 1, 0});
  for (uint32_t x = 0; x < 2048; ++x) {
    bitmap.at(x, 0) = bitmap.at(x, 1) = 0.5f + 0.5f * std::sin(2 * 3.14159265f * static_cast<float>(x) / 8);
  }
  const double steepest = 0.5 * 2 * 3.14159265 / 8 * 2048 * 20;
  for (int round = 0; round < 50; ++round) {
    const Points points = evaluate(bitmap, random, 1);
    for (size_t i = 0; i < kPoints; ++i) {
      const GreyBitmap::Patch want = bitmap.patch(points.u[i], points.v[i]);
      if (want.edge < 1e-2) continue;
      ASSERT_NEAR(points.slopeU[i] / steepest, want.slopeU / steepest, 1e-3);
      ASSERT_NEAR(points.slopeV[i] / steepest, 0, 1e-3);
    }
  }
}

TEST_P(TextureTest, stepsHaveNoSlope) {
  std::mt19937 random(5);
  GreyBitmap nearest(4, 4, {1, 0, 0, 0, 1, 0}), board = nearest;
  nearest.record.nearest = 1;
  board.record.kind = static_cast<uint32_t>(TextureKind::checkerboard);
  board.record.color1[0] = 1;
  for (uint32_t i = 0; i < 16; ++i) nearest.at(i % 4, i / 4) = static_cast<float>(i);
  for (const GreyBitmap* texture : {&nearest, &board}) {
    const Points points = evaluate(*texture, random, 2);
    for (size_t i = 0; i < kPoints; ++i) {
      EXPECT_EQ(points.slopeU[i], 0);
      EXPECT_EQ(points.slopeV[i], 0);
    }
  }
}

}  // namespace
}  // namespace wavecrest
