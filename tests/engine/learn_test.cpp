// The parts that learning is made of: blocks of iterations, sums of integers, cells, histograms as alias tables; and
// what a guide makes of records.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <thread>
#include <vector>

#include "engine/learn/alias_table.h"
#include "engine/learn/blocks.h"
#include "engine/learn/cell_tree.h"
#include "engine/learn/guide.h"
#include "engine/learn/integer_sums.h"
#include "engine/learn/learned_directions.h"
#include "tests/engine/saved_state.h"
#include "tests/engine/sphere_integral.h"

namespace wavecrest {
namespace {

TEST(Blocks, haveAsManyIterationsAsAllBeforeThem) {
  uint64_t end = 0;
  for (uint64_t next = 1; next <= 32; next *= 2) {
    for (uint64_t iteration = end; iteration < next; ++iteration) {
      EXPECT_EQ(beginOfBlock(iteration), end) << iteration;
      EXPECT_EQ(endOfBlock(iteration), next) << iteration;
    }
    end = next;
  }
}

TEST(Blocks, gatherInTheirFirstIterations) {
  // 16 to 31, of which 16 to 19 gather.
  for (uint64_t iteration = 16; iteration < 32; ++iteration) {
    EXPECT_EQ(gathers(iteration, 4), iteration < 20) << iteration;
    EXPECT_EQ(endOfRun(iteration, 4), iteration < 20 ? 20u : 32u) << iteration;
  }
  EXPECT_EQ(endOfRun(5, 64), 8u) << "a block that gathers as a whole";
}

// A histogram on the square, of which each direction has its part of the sphere.
TEST(LearnedDirections, addUpToOneOverTheSphere) {
  LearnedDirections learned;
  double sum = 0;
  for (size_t bin = 0; bin < kGuideBins; ++bin) sum += learned.squareDensity[bin] = static_cast<float>(1 + bin % 7);
  const double integral = sphereIntegral(400, [&](const auto& direction) { return learned.density(direction); });
  EXPECT_NEAR(integral, sum * 4 / kGuideBins, 2e-3 * integral);
  // The middle of the square is +z.
  learned.squareDensity = {};
  for (const uint32_t row : {kGuideSide / 2 - 1, kGuideSide / 2})
    learned.squareDensity[row * kGuideSide + kGuideSide / 2] = 8;
  EXPECT_NEAR(learned.density({0.01, 0.01, std::sqrt(1 - 2e-4)}), 8, 0.5);
  EXPECT_EQ(learned.density({-0.01, 0.01, std::sqrt(1 - 2e-4)}), 0);
  EXPECT_EQ(learned.density({0, 0, -1}), 0);
}

TEST(IntegerSums, holdTheirLimitInAnyOrder) {
  const auto big = toAddend(kAddendLimit);
  uint64_t sum = kSumLimit - big - 1;
  addTo(sum, big);
  EXPECT_EQ(sum, kSumLimit - 1) << "next to the limit nothing is lost";
  addTo(sum, 1);
  EXPECT_EQ(sum, kSumLimit);
  addTo(sum, big);
  EXPECT_EQ(sum, kSumLimit);
  EXPECT_EQ(toAddend(1e300), big);
  for (const double nothing : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_EQ(toAddend(nothing), 0u) << nothing;
  EXPECT_EQ(toAddend(0.5), 1u);
  EXPECT_EQ(toAddend(0.49), 0u);
}

TEST(IntegerSums, addUpOnSeveralThreads) {
  uint64_t sum = 0;
  std::vector<std::thread> threads;
  for (uint64_t t = 1; t <= 4; ++t) {
    threads.emplace_back([&sum, t] {
      for (int i = 0; i < 5000; ++i) addTo(sum, t);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sum, 5000u * 10);
}

// Units of a bin in all columns of its alias table.
GuideUnits drawnBy(const std::array<uint32_t, kGuideBins>& words) {
  GuideUnits drawn{};
  for (uint32_t column = 0; column < kGuideBins; ++column) {
    const GuideBin bin = GuideBin::of(words[column]);
    drawn[column] += bin.own;
    drawn[bin.other] += (1u << kGuideColumnBits) - bin.own;
  }
  return drawn;
}

TEST(AliasTable, drawsEveryBinWithExactlyItsUnits) {
  std::vector<std::array<double, kGuideBins>> cases(4);
  cases[0].fill(1);
  cases[1][77] = 1e-300;  // alone
  for (size_t bin = 0; bin < kGuideBins; ++bin) {
    cases[2][bin] = std::pow(1.7, static_cast<double>(bin % 40));
    cases[3][bin] = bin % 2 == 0 ? 1e-12 : 3 + std::sin(static_cast<double>(bin));
  }
  for (const auto& weights : cases) {
    const GuideUnits units = unitsOf(weights);
    EXPECT_EQ(std::accumulate(units.begin(), units.end(), uint64_t{0}), uint64_t{1} << kGuideUnitBits);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (size_t bin = 0; bin < kGuideBins; ++bin) {
      EXPECT_NEAR(units[bin], weights[bin] / total * (1u << kGuideUnitBits), kGuideBins);
      EXPECT_LT(units[bin], 1u << kGuideUnitBits);
    }
    std::array<uint32_t, kGuideBins> words{};
    makeAliasTable(units, words.data());
    EXPECT_EQ(drawnBy(words), units);
    for (uint32_t bin = 0; bin < kGuideBins; ++bin) EXPECT_EQ(GuideBin::of(words[bin]).units, units[bin]);
    EXPECT_TRUE(isAliasTable(words.data()));
    for (const uint32_t bit : {0u, 9u, 20u}) {
      std::array<uint32_t, kGuideBins> damaged = words;
      damaged[77] ^= 1u << bit;
      EXPECT_FALSE(isAliasTable(damaged.data())) << bit;
    }
  }
}

constexpr double kCenter[3] = {1, 2, 3}, kHalf[3] = {4, 4, 2};

// The cell of a place in [0, 1)^3 of the box, as kernels find it.
uint32_t cellAt(const CellTreeView& tree, uint32_t root, const std::array<double, 3>& place) {
  uint32_t node = tree.nodes[root];
  std::array<double, 3> rest = place;
  for (size_t axis = 0; node < kCellLeaf; axis = (axis + 1) % 3) {
    rest[axis] *= 2;
    const bool upper = rest[axis] >= 1;
    if (upper) rest[axis] -= 1;
    node = tree.nodes[node + (upper ? 1 : 0)];
  }
  return node & ~kCellLeaf;
}

TEST(CellTree, halvesTheBoxAlongItsAxesInTurn) {
  CellTree tree(kCenter, kHalf, 100);
  EXPECT_EQ(tree.cells(), kCellRoots);
  const uint32_t right = tree.split(2), far = tree.split(right);
  EXPECT_EQ(tree.cells(), kCellRoots + 2);
  EXPECT_EQ(cellAt(tree.view(), 2, {0.4, 0.9, 0}), 2u);
  EXPECT_EQ(cellAt(tree.view(), 2, {0.6, 0.4, 0}), right);
  EXPECT_EQ(cellAt(tree.view(), 2, {0.6, 0.6, 0}), far);
  EXPECT_EQ(cellAt(tree.view(), 3, {0.6, 0.6, 0}), 3u);
  // 1024 places along each axis, whatever the box's shape.
  constexpr float kLeast[3] = {-3, -2, 1}, kScale[3] = {128, 128, 256};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(tree.view().least[axis], kLeast[axis]) << axis;
    EXPECT_EQ(tree.view().scale[axis], kScale[axis]) << axis;
  }
}

TEST(CellTree, splitsNoFurtherThanItMay) {
  CellTree few(kCenter, kHalf, kCellRoots + 1);
  EXPECT_TRUE(few.canSplit(0));
  few.split(0);
  EXPECT_FALSE(few.canSplit(0)) << "as many cells as may be";
  CellTree deep(kCenter, kHalf, 1000);
  for (uint32_t level = 0; level < kCellLevels; ++level) {
    ASSERT_TRUE(deep.canSplit(0));
    deep.split(0);
  }
  EXPECT_FALSE(deep.canSplit(0)) << "as small as cells get";
}

TEST(CellTree, comesBackFromItsBytesAndFromNoOthers) {
  CellTree tree(kCenter, kHalf, 20);
  for (const uint32_t cell : {0u, 0u, 6u, 3u}) tree.split(cell);
  const auto bytes = savedState(tree);
  const auto read = [](const std::vector<unsigned char>& state, size_t most) {
    CellTree other(kCenter, kHalf, most);
    StateReader in(state);
    other.restore(in);
    in.finish();
    return savedState(other);
  };
  EXPECT_EQ(read(bytes, 20), bytes);
  EXPECT_THROW(read(bytes, 8), StateError);
  // Whatever one node is replaced by, what is accepted is a tree.
  for (size_t at = sizeof(uint64_t); at < bytes.size(); at += 3) {
    auto damaged = bytes;
    damaged[at] ^= 0x85;
    try {
      read(damaged, 20);
    } catch (const StateError&) {
    }
  }
}

// Records of paths that went on from cell 0 into one bin, and what each of them brought back.
struct Brought {
  size_t count = 0;
  float value = 1, survival = 1, slope = 0;
  uint32_t bin = 85;
};

void teach(Guide& guide, const Brought& brought) {
  DirectionRecords records;
  Arena arena(records.bytes(brought.count));
  records.bind(arena, brought.count);
  records.size = brought.count;
  for (size_t i = 0; i < brought.count; ++i) {
    records.bin[i] = brought.bin;
    records.inverseThroughput[i] = 1;
    records.pdf[i] = 0.25f;
    records.slope[i] = brought.slope;
    records.survival[i] = brought.survival;
  }
  Radiance<float> radiance;  // of the one lane that all records are of
  Arena lane(radiance.bytes(1));
  radiance.bind(lane, 1);
  radiance.red[0] = radiance.green[0] = radiance.blue[0] = brought.value;
  guide.gather(records, radiance);
}

// For pixels of brightness 1.
Guide untaughtGuide() { return {kCenter, kHalf, GuideTarget::radiance, 0, 1}; }

TEST(Guide, learnsFromSumsOfWhichHalfRemain) {
  Guide guide = untaughtGuide();
  teach(guide, {.count = 600, .value = 1});
  teach(guide, {.count = 600, .value = 4, .survival = 0.5f});
  guide.fold();
  // A path that survived with probability 1/2 is two visits, one of which brought nothing. The mean square is (600 +
  // 600 x 16 / 2) / (600 + 1200).
  EXPECT_NEAR(guide.view().roots[0], std::sqrt(3.0), 1e-5);
  LearnedDirections learned = guide.learnedIn(0);
  EXPECT_EQ(learned.guidedShare, 0.5);
  // 64, 8 and 1 % of the histogram, whose bins have an area of 1/64.
  EXPECT_NEAR(learned.squareDensity[85], 40.96, 0.01);
  for (const size_t side : {69u, 84u, 86u, 101u}) EXPECT_NEAR(learned.squareDensity[side], 5.12, 0.01) << side;
  for (const size_t corner : {68u, 70u, 100u, 102u}) EXPECT_NEAR(learned.squareDensity[corner], 0.64, 0.01) << corner;
  EXPECT_EQ(learned.squareDensity[87], 0);
  EXPECT_EQ(guide.learnedIn(1).guidedShare, 0) << "a cell without records";
  EXPECT_EQ(guide.statistics().records, 600u);
  EXPECT_EQ(guide.statistics().guidedShare, 0) << "before the fold";

  // The second block has half of the first one's sums as well. A bin on an edge has neighbours over it.
  constexpr size_t kEdge = 5 * kGuideSide, kOpposite = 10 * kGuideSide;
  teach(guide, {.count = 1000, .value = 2, .bin = kEdge});
  guide.fold();
  EXPECT_NEAR(guide.view().roots[0], std::sqrt((2700.0 + 4000) / (900 + 1000)), 1e-5);
  learned = guide.learnedIn(0);
  EXPECT_NEAR(learned.squareDensity[85] / learned.squareDensity[kEdge], 1500.0 / 2000, 1e-3);
  EXPECT_NEAR(learned.squareDensity[kOpposite] / learned.squareDensity[kEdge], 8.0 / 64, 1e-3);
  EXPECT_NEAR(learned.squareDensity[kOpposite + kGuideSide] / learned.squareDensity[kEdge], 1.0 / 64, 1e-3);
  EXPECT_EQ(guide.statistics().guidedShare, 0.5);
}

// Newton's step is sum(v s) / sum(v s^2), at most 0.2, over the slopes s of one block.
TEST(Guide, movesTheShareByTheSlopesOfABlock) {
  Guide guide = untaughtGuide();
  teach(guide, {.count = 1000});
  guide.fold();
  const auto shareAfter = [&](size_t up, size_t down) {
    teach(guide, {.count = up, .slope = 0.5f});
    teach(guide, {.count = down, .slope = -0.5f});
    guide.fold();
    return 1 - guide.learnedIn(0).guidedShare;
  };
  EXPECT_NEAR(shareAfter(300, 100), 0.7, 1e-6) << "100 / 100 is cut";
  EXPECT_NEAR(shareAfter(210, 190), 0.8, 1e-6) << "10 / 100";
  EXPECT_NEAR(shareAfter(600, 0), double{kMostBsdfShare}, 1e-6);
  EXPECT_NEAR(shareAfter(285, 315), double{kMostBsdfShare} - 0.1, 1e-6) << "-15 / 150";
}

TEST(Guide, keepsSquaresOfRareBrightPaths) {
  Guide guide = untaughtGuide();
  teach(guide, {.count = 1000, .value = 5000});
  guide.fold();
  EXPECT_NEAR(guide.view().roots[0], 5000, 0.01);
  EXPECT_EQ(guide.statistics().saturated, 0u);
}

// Values of 1 with slopes of 2^32: sums over positive and negative slopes and that of squared slopes reach the limit,
// no bin and no sum of squared values does.
TEST(Guide, countsSaturatedSumsOfSlopes) {
  Guide guide = untaughtGuide();
  for (const float slope : {0x1p32f, -0x1p32f}) teach(guide, {.count = 2048, .slope = slope});
  guide.fold();
  EXPECT_EQ(guide.statistics().saturated, 3u);
}

// Kernels read indices of bins as signed numbers of 32 bits.
TEST(Guide, hasNoMoreBinsThanIndices) {
  const size_t bytesOfCell = Guide::bytesFor(0) / kCellRoots;
  EXPECT_EQ(Guide::bytesFor(100 * bytesOfCell), 100 * bytesOfCell);
  EXPECT_EQ(Guide::bytesFor(size_t{1} << 40), bytesOfCell * ((size_t{1} << 31) / kGuideBins));
}

}  // namespace
}  // namespace wavecrest
