// Roulette of connections joins with exactly the probability that it divides by (METHODS 5.9): over all 2^24 numbers,
// so nothing here is random. Under sanitizers at two depths alone.
#include <gtest/gtest.h>

#include <vector>

#include "tests/effort.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/roulette_entries.h"

namespace wavecrest {
namespace {

class RouletteLanesTest : public IsaTest {};

TEST_P(RouletteLanesTest, keepsTheMeanOfTheSmallestContributions) {
  const auto& roulette = entries<RouletteEntries>();
  const std::vector<uint32_t> depths = kFullSpeed ? std::vector{1u, 2u, 5u, 13u, 100u} : std::vector{1u, 100u};
  for (const float carried : {0.7f, 1e-3f, 1e-5f, 1e-6f, 3e-7f, 1e-7f, 1e-9f, 1e-12f}) {
    const float chance = roulette.chance(carried, 1);
    EXPECT_GE(chance, carried);
    EXPECT_LE(chance, carried + 0x1p-24f) << "no more shadow rays than the grid asks for";
    for (const uint32_t depth : depths) {
      const auto joined = static_cast<double>(roulette.joined(chance, depth));
      EXPECT_EQ(joined * 0x1p-24 / static_cast<double>(chance), 1) << carried << " at depth " << depth;
    }
  }
}

TEST_P(RouletteLanesTest, joinsAllThatCarryTheLimit) {
  const auto& roulette = entries<RouletteEntries>();
  for (const float carried : {1.0f, 1.5f, 1e6f}) {
    EXPECT_EQ(roulette.chance(carried, 1), 1);
    EXPECT_EQ(roulette.joined(1, 7), uint64_t{1} << 24);
  }
}

WAVECREST_TEST_EVERY_ISA(RouletteLanesTest);

}  // namespace
}  // namespace wavecrest
