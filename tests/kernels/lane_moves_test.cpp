// How lanes move, among each other and to and from memory, against plain C++ on every instruction set.
#include <random>
#include <vector>

#include "tests/kernels/isa_test.h"
#include "tests/kernels/lane_inputs.h"
#include "tests/kernels/lanes_entries.h"

namespace wavecrest {
namespace {

class LaneMovesTest : public IsaTest {
 protected:
  const LanesEntries& lanes() { return entries<LanesEntries>(); }
};
WAVECREST_TEST_EVERY_ISA(LaneMovesTest);

TEST_P(LaneMovesTest, gatherReadsTheIndexedValues) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(1000, 5);
  const std::vector<double> doubles = realInputs<double>(1000, 6);
  const std::vector<uint32_t> uints = uintInputs(1000, 7);
  std::vector<uint32_t> index(n);
  for (size_t i = 0; i < n; ++i) index[i] = static_cast<uint32_t>((i * 7919 + 13) % 1000);
  GuardedColumn<float> floatsOut(n);
  GuardedColumn<double> doublesOut(n);
  GuardedColumn<uint32_t> uintsOut(n);
  lanes().gather(floats.data(), doubles.data(), uints.data(), index.data(), floatsOut.data(), doublesOut.data(),
                 uintsOut.data());
  for (size_t i = 0; i < n; ++i) {
    EXPECT_EQ(floatsOut[i], floats[index[i]]);
    EXPECT_EQ(doublesOut[i], doubles[index[i]]);
    EXPECT_EQ(uintsOut[i], uints[index[i]]);
  }
  EXPECT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
}

TEST_P(LaneMovesTest, rowsAreReadIntoColumns) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(1003, 5);
  const std::vector<double> doubles = realInputs<double>(1003, 6);
  const std::vector<uint32_t> uints = uintInputs(1003, 7);
  std::vector<uint32_t> index(n);
  for (size_t i = 0; i < n; ++i) index[i] = static_cast<uint32_t>((i * 7919 + 13) % 1000);
  for (const auto read : {lanes().gatherFour, lanes().loadFour}) {
    GuardedColumn<float> floatsOut(4 * n);
    GuardedColumn<double> doublesOut(4 * n);
    GuardedColumn<uint32_t> uintsOut(4 * n);
    read(floats.data(), doubles.data(), uints.data(), index.data(), floatsOut.data(), doublesOut.data(),
         uintsOut.data());
    for (size_t column = 0; column < 4; ++column) {
      for (size_t i = 0; i < n; ++i) {
        EXPECT_EQ(floatsOut[column * n + i], floats[index[i] + column]);
        EXPECT_EQ(doublesOut[column * n + i], doubles[index[i] + column]);
        EXPECT_EQ(uintsOut[column * n + i], uints[index[i] + column]);
      }
    }
    EXPECT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LaneMovesTest, storeRecordsTransposesSixteenColumns) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16 * n, 5);
  const std::vector<double> doubles = realInputs<double>(16 * n, 6);
  for (const bool stream : {false, true}) {
    GuardedColumn<float> floatsOut(16 * n);
    GuardedColumn<double> doublesOut(16 * n);
    lanes().storeRecords(floats.data(), doubles.data(), stream, floatsOut.data(), doublesOut.data());
    for (size_t lane = 0; lane < n; ++lane) {
      for (size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(floatsOut[16 * lane + i], floats[i * n + lane]);
        EXPECT_EQ(doublesOut[16 * lane + i], doubles[i * n + lane]);
      }
    }
    EXPECT_TRUE(floatsOut.intact() && doublesOut.intact());
  }
}

TEST_P(LaneMovesTest, compressMovesTheChosenLanesToTheFrontInOrder) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16, 8);
  const std::vector<double> doubles = realInputs<double>(16, 9);
  const std::vector<uint32_t> uints = uintInputs(16, 10);
  const uint32_t masks = n == 16 ? 4096 : 1u << n;  // all masks, or a sample of the 65,536
  for (uint32_t m = 0; m < masks; ++m) {
    const uint32_t mask = n == 16 ? m * 16 + (m >> 8) : m;
    std::vector<uint32_t> flags(n);
    for (size_t i = 0; i < n; ++i) flags[i] = mask >> i & 1;
    GuardedColumn<float> floatsOut(n);
    GuardedColumn<double> doublesOut(n);
    GuardedColumn<uint32_t> uintsOut(n);
    const size_t kept = lanes().compress(flags.data(), floats.data(), doubles.data(), uints.data(), floatsOut.data(),
                                         doublesOut.data(), uintsOut.data());
    size_t next = 0;
    for (size_t i = 0; i < n; ++i) {
      if (flags[i] == 0) continue;
      ASSERT_EQ(floatsOut[next], floats[i]) << "mask " << mask;
      ASSERT_EQ(doublesOut[next], doubles[i]) << "mask " << mask;
      ASSERT_EQ(uintsOut[next], uints[i]) << "mask " << mask;
      ++next;
    }
    ASSERT_EQ(kept, next);
    ASSERT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LaneMovesTest, inOrderTakesEachLaneFromWhereItIsTold) {
  const size_t n = lanes().lanes;
  const std::vector<float> floats = realInputs<float>(16, 8);
  const std::vector<double> doubles = realInputs<double>(16, 9);
  const std::vector<uint32_t> uints = uintInputs(16, 10);
  std::mt19937 random(1);
  for (int k = 0; k < 100; ++k) {
    std::vector<uint32_t> order(n);
    for (uint32_t& lane : order) lane = static_cast<uint32_t>(random() % n);
    GuardedColumn<float> floatsOut(n);
    GuardedColumn<double> doublesOut(n);
    GuardedColumn<uint32_t> uintsOut(n);
    lanes().inOrder(order.data(), floats.data(), doubles.data(), uints.data(), floatsOut.data(), doublesOut.data(),
                    uintsOut.data());
    for (size_t i = 0; i < n; ++i) {
      ASSERT_EQ(floatsOut[i], floats[order[i]]);
      ASSERT_EQ(doublesOut[i], doubles[order[i]]);
      ASSERT_EQ(uintsOut[i], uints[order[i]]);
    }
    ASSERT_TRUE(floatsOut.intact() && doublesOut.intact() && uintsOut.intact());
  }
}

TEST_P(LaneMovesTest, splitOrderPutsSomeInFrontAndTheRestAtTheEndBackwards) {
  const size_t n = lanes().lanes;
  std::mt19937 random(2);
  for (int k = 0; k < 5000; ++k) {
    std::vector<uint32_t> flags(n), rest(n), front, back, order(n);
    const uint32_t odds = static_cast<uint32_t>(random() % 4);  // also all in front, and all at the end
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t kind = odds == 0 ? 0 : odds == 1 ? 1 : static_cast<uint32_t>(random() % 3);
      flags[i] = kind == 0 ? 1 : 0;
      rest[i] = kind == 1 ? 1 : 0;
      if (kind == 0) front.push_back(i);
      if (kind == 1) back.push_back(i);
    }
    lanes().splitOrder(flags.data(), rest.data(), order.data());
    for (size_t i = 0; i < front.size(); ++i) ASSERT_EQ(order[i], front[i]);
    for (size_t i = 0; i < back.size(); ++i) ASSERT_EQ(order[n - 1 - i], back[i]);
    for (const uint32_t lane : order) ASSERT_LT(lane, n);
  }
}

}  // namespace
}  // namespace wavecrest
