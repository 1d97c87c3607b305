// Sky and sun of an environment are drawn as often as their densities say. Nothing here is random.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/kernels/isa_test.h"
#include "tests/kernels/sky_sampling_entries.h"

namespace wavecrest {
namespace {

constexpr uint32_t kRows = 2049;  // of a baked sky
constexpr float kSunShare = 0.9f;
constexpr double kSunDirection[3] = {0.6, 0.8, 0}, kSunChord2 = 0.01;

// Numbers of 24 bits that choose a row: four around the end of each row's range. As rows rise with the number, these
// tell how many numbers each row has.
std::vector<float> numbersAtRowEnds() {
  std::vector<float> numbers;
  for (uint64_t row = 1; row < kRows; ++row) {
    const uint64_t end = (row << 24) / kRows;
    for (uint64_t i = end - 1; i <= end + 2; ++i) numbers.push_back(static_cast<float>(i) * 0x1p-24f);
  }
  return numbers;  // 8192: whole blocks at every width
}

using SampledDirections = std::array<std::vector<float>, 3>;

class SkySamplingTest : public IsaTest {
 protected:
  // Of a map of one column with a sun. a: of each direction; d: of all.
  static SampledDirections sample(const std::vector<float>& a, float d) {
    const std::vector<AliasEntry> table(kRows, AliasEntry{1, 0});  // every texel is kept
    EnvironmentView map{.table = table.data(), .width = 1, .height = kRows};
    for (size_t i = 0; i < 3; ++i) {
      map.toLocal[i][i] = 1;
      map.sunDirection[i] = kSunDirection[i];
    }
    map.sunShare = kSunShare;
    map.sunChord2 = kSunChord2;
    const std::vector<float> middle(a.size(), 0.5f), place(a.size(), d);
    SampledDirections out;
    for (auto& column : out) column.resize(a.size());
    entries<SkySamplingEntries>().sample(map, {a.data(), middle.data(), middle.data(), place.data()},
                                         {out[0].data(), out[1].data(), out[2].data()}, a.size());
    return out;
  }
};
WAVECREST_TEST_EVERY_ISA(SkySamplingTest);

// entryShares (engine/compile/pick_table.h) counts the numbers of each row by the same product.
TEST_P(SkySamplingTest, rowsOfTheSkyHaveAsManyNumbersAsWithoutASun) {
  const std::vector<float> numbers = numbersAtRowEnds();
  for (const float place : {0.925f, 0.95f, 0.975f}) {
    const SampledDirections directions = sample(numbers, place);
    for (size_t i = 0; i < numbers.size(); ++i) {
      const auto x = static_cast<double>(directions[0][i]), y = static_cast<double>(directions[1][i]),
                 z = static_cast<double>(directions[2][i]);
      const double theta = std::atan2(std::hypot(x, z), y);
      ASSERT_EQ(static_cast<uint32_t>(theta / std::numbers::pi * kRows),
                static_cast<uint32_t>(numbers[i] * static_cast<float>(kRows)))
          << numbers[i] << ' ' << place;
    }
  }
}

// Area on the sphere is proportional to the squared chord.
TEST_P(SkySamplingTest, sunIsDrawnByItsShareAndEvenly) {
  const std::vector<float> numbers = numbersAtRowEnds();
  for (const float place : {0.0f, 0.5f, 0.899f}) {
    const SampledDirections directions = sample(numbers, place);
    for (size_t i = 0; i < numbers.size(); ++i) {
      double chord2 = 0;
      for (size_t c = 0; c < 3; ++c) {
        const double away = static_cast<double>(directions[c][i]) - kSunDirection[c];
        chord2 += away * away;
      }
      ASSERT_NEAR(chord2, static_cast<double>(numbers[i]) * kSunChord2, 1e-6) << numbers[i] << ' ' << place;
    }
  }
}

}  // namespace
}  // namespace wavecrest
