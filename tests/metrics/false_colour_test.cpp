#include "metrics/false_colour.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace wavecrest {
namespace {

using Pixel = std::array<uint8_t, 3>;

std::vector<Pixel> colours(const std::vector<float>& map, double range) {
  const Image8 picture = falseColour(map, static_cast<uint32_t>(map.size()), 1, range);
  std::vector<Pixel> pixels;
  for (size_t i = 0; i < picture.pixels.size(); i += 3)
    pixels.push_back({picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]});
  return pixels;
}

// The published ends and middle of the magma scale.
TEST(FalseColour, RunsFromNearBlackToPaleYellow) {
  EXPECT_EQ(colours({0, 1, 2}, 2), (std::vector<Pixel>{{0, 0, 4}, {181, 54, 122}, {252, 253, 191}}));
}

TEST(FalseColour, ShowsWhatIsBeyondTheRangeAsItsEnds) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(colours({-1, 5, inf, nan}, 2),
            (std::vector<Pixel>{{0, 0, 4}, {252, 253, 191}, {252, 253, 191}, {0, 0, 4}}));
  EXPECT_EQ(colours({0, 3}, 0), (std::vector<Pixel>{{0, 0, 4}, {0, 0, 4}})) << "no range: nothing to show";
}

TEST(FalseColour, ShowsMapsWithoutBounds) {
  constexpr float kLargest = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::denorm_min();
  constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr Pixel kDark{0, 0, 4}, kMiddle{181, 54, 122}, kBright{252, 253, 191};
  EXPECT_EQ(colours({0, 1, kLargest, kInf, -kInf, kNan}, double{kInf}),
            (std::vector<Pixel>{kDark, kDark, kDark, kBright, kDark, kDark}));
  EXPECT_EQ(colours({0, kLargest / 2, kLargest, kInf}, double{kLargest}),
            (std::vector<Pixel>{kDark, kMiddle, kBright, kBright}));
  EXPECT_EQ(colours({0, kLeast, kInf}, 1e-320), (std::vector<Pixel>{kDark, kBright, kBright}));
  EXPECT_EQ(colours({0, 1, kInf}, double{kNan}), (std::vector<Pixel>{kDark, kDark, kDark})) << "no range";
}

TEST(FalseColour, BrightensWithTheValue) {
  std::vector<float> ramp;
  for (int i = 0; i <= 64; ++i) ramp.push_back(static_cast<float>(i) / 64);
  double last = -1;
  for (const Pixel& p : colours(ramp, 1)) {
    const double luminance = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
    EXPECT_GT(luminance, last);
    last = luminance;
  }
}

TEST(Quantile, IsTheValueBelowWhichThatPartLies) {
  std::vector<float> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(static_cast<float>((i * 387) % 1001));  // 0..1000 shuffled
  EXPECT_EQ(quantile(values, 0.999), 999);
  EXPECT_EQ(quantile(values, 0), 0);
  EXPECT_EQ(quantile(values, 1), 1000);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace wavecrest
