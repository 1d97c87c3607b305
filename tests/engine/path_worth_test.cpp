// What paths are worth to an image (engine/learn/path_worth.h).
#include "engine/learn/path_worth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "tests/engine/saved_state.h"

namespace wavecrest {
namespace {

constexpr size_t kPixels = 3 * kWorthRun + 5;  // the last run is short

// Records of vertices of the first depth that have these worths, whose paths survived with this probability.
class Records {
 public:
  explicit Records(std::span<const float> worths, float survival = 1) : arena_(records_.bytes(worths.size())) {
    records_.bind(arena_, worths.size());
    records_.size = worths.size();
    for (size_t i = 0; i < worths.size(); ++i) {
      records_.worth[i] = worths[i];
      records_.survival[i] = survival;
    }
  }
  const DirectionRecords& get() const { return records_; }

 private:
  DirectionRecords records_;
  Arena arena_;
};

GuideView viewOf(const PathWorth& worth) {
  GuideView view;
  worth.showIn(view);
  return view;
}

std::vector<float> bright(std::array<float, 4> runs) {
  std::vector<float> luminance;
  for (size_t pixel = 0; pixel < kPixels; ++pixel) luminance.push_back(runs[pixel / kWorthRun]);
  return luminance;
}

TEST(PathWorth, knowsNothingAtFirst) {
  PathWorth worth(kPixels);
  EXPECT_EQ(viewOf(worth).perBrightness, nullptr);
  worth.fold(bright({1, 1, 1, 1}));
  EXPECT_NE(viewOf(worth).perBrightness, nullptr);
  EXPECT_FALSE(viewOf(worth).decidesSurvival) << "what the first vertices are worth is not known yet";
}

TEST(PathWorth, isTwelveAtTheFirstVerticesWhateverTheUnits) {
  for (const float unit : {1e-3f, 1.0f, 1e3f}) {
    PathWorth worth(kPixels);
    worth.fold(bright({unit, 2 * unit, 4 * unit, 8 * unit}));
    // Roots of a cell in which three times a pixel's brightness comes back.
    for (int block = 0; block < 3; ++block) {
      const float* const per = viewOf(worth).perBrightness;
      std::vector<float> worths;
      for (size_t run = 0; run < 4; ++run) worths.push_back(per[run] * 3 * unit * std::exp2f(static_cast<float>(run)));
      worth.gather(Records(worths).get());
      worth.fold(bright({unit, 2 * unit, 4 * unit, 8 * unit}));
    }
    EXPECT_TRUE(viewOf(worth).decidesSurvival);
    for (size_t run = 0; run < 4; ++run) {
      const float brightness = unit * std::exp2f(static_cast<float>(run));
      EXPECT_NEAR(viewOf(worth).perBrightness[run] * 3 * brightness, 12, 0.05) << unit << ", run " << run;
    }
  }
}

// Half of 2000 vertices are worth 17, half 0.05: their root mean square is 12.02, whoever survives.
TEST(PathWorth, isTwelveOverAllFirstVerticesNotOverSurvivorsAlone) {
  PathWorth worth(kPixels);
  worth.fold(bright({1, 1, 1, 1}));
  EXPECT_EQ(viewOf(worth).perBrightness[0], 12);
  worth.gather(Records(std::vector<float>(950, 17.0f), 0.95f).get());
  worth.gather(Records(std::vector<float>(50, 0.05f), 0.05f).get());
  worth.fold(bright({1, 1, 1, 1}));
  EXPECT_NEAR(viewOf(worth).perBrightness[0], 12 * 12 / 12.02, 0.02);
}

TEST(PathWorth, holdsTheLimitOfItsSums) {
  PathWorth worth(kPixels);
  worth.fold(bright({1, 1, 1, 1}));
  // 20 x 900,000 squares of 2^32, in units of 2^-8, are more than 2^64.
  constexpr size_t kRecords = 900'000;
  worth.gather(Records(std::vector<float>(kRecords, 1e30f), 0.05f).get());
  worth.fold(bright({1, 1, 1, 1}));
  const double meanSquare = 0x1p62 / (20.0 * kRecords * 0x1p8);
  EXPECT_NEAR(viewOf(worth).perBrightness[0] * std::sqrt(meanSquare), 12 * 12, 0.1);
}

TEST(PathWorth, takesNoPixelForDarkerThanATwentiethOfTheImage) {
  PathWorth worth(kPixels);
  worth.fold(bright({0, 1e-9f, 3, 3}));
  const float* const per = viewOf(worth).perBrightness;
  EXPECT_EQ(per[0], per[1]);
  const double mean = 3 * static_cast<double>(kPixels - 2 * kWorthRun) / kPixels;
  EXPECT_NEAR(per[0] / per[2], 20 * 3 / mean, 1e-3);
}

TEST(PathWorth, isUnknownWhereNothingIsBrightAndWhereNothingIsFinite) {
  for (const float luminance : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    PathWorth worth(kPixels);
    worth.fold(bright({luminance, luminance, luminance, luminance}));
    for (size_t run = 0; run < 4; ++run) EXPECT_EQ(viewOf(worth).perBrightness[run], 0) << luminance;
  }
  // After worths of 0, NaN, infinity and 1e30 all is still finite and positive.
  PathWorth worth(kPixels);
  worth.fold(bright({1, 1, 1, 1}));
  const std::array odd{0.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f};
  worth.gather(Records(odd).get());
  worth.fold(bright({1, 1, 1, 1}));
  for (size_t run = 0; run < 4; ++run) {
    EXPECT_GT(viewOf(worth).perBrightness[run], 0);
    EXPECT_TRUE(std::isfinite(viewOf(worth).perBrightness[run]));
  }
}

TEST(PathWorth, comesBackFromItsBytesAndFromNoOthers) {
  PathWorth worth(kPixels);
  worth.fold(bright({1, 2, 3, 4}));
  worth.gather(Records(std::array{3.0f, 5.0f}).get());
  const std::vector<unsigned char> saved = savedState(worth);
  PathWorth other(kPixels);
  restoreState(other, saved);
  EXPECT_EQ(savedState(other), saved);
  worth.fold(bright({4, 3, 2, 1}));
  other.fold(bright({4, 3, 2, 1}));
  for (size_t run = 0; run < 4; ++run) EXPECT_EQ(viewOf(other).perBrightness[run], viewOf(worth).perBrightness[run]);
  // The last four bytes are the last run's brightness, here a NaN.
  std::vector<unsigned char> damaged = saved;
  std::fill(damaged.end() - 4, damaged.end(), 0xff);
  EXPECT_THROW(restoreState(other, damaged), StateError);
}

}  // namespace
}  // namespace wavecrest
