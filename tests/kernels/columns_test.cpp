// Columns: allocation, padding, claims, dropped columns, and the memory plan of a wave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "kernels/columns/memory_block.h"
#include "kernels/columns/wave.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// Three types of different sizes: what no record of the renderer has in one place.
struct Mixed : Columns<Mixed> {
  Column<float> small;
  Column<double> large;
  Column<uint32_t> word;
  auto all() { return std::tie(small, large, word); }
};

bool aligned(const void* p) { return reinterpret_cast<uintptr_t>(p) % kColumnAlignment == 0; }

constexpr size_t kMostItems = 2 * kColumnPadding + 1;

TEST(Arena, handsOutAlignedBlocksThatDoNotOverlap) {
  Arena arena(4096);
  const auto* bytes = arena.take<uint8_t>(3);
  const auto* words = arena.take<uint32_t>(17);
  const auto* doubles = arena.take<double>(1);
  EXPECT_TRUE(aligned(bytes) && aligned(words) && aligned(doubles));
  EXPECT_GE(reinterpret_cast<const uint8_t*>(words), bytes + 3);
  EXPECT_GE(reinterpret_cast<const uint8_t*>(doubles), reinterpret_cast<const uint8_t*>(words + 17));
  EXPECT_EQ(arena.used(), 64u + 128u + 64u);
}

TEST(Arena, refusesMoreThanItHolds) {
  Arena arena(128);
  arena.take<float>(16);
  EXPECT_THROW(arena.take<float>(17), std::length_error);
  EXPECT_NO_THROW(arena.take<float>(16));  // a refused request takes nothing
  EXPECT_THROW(arena.take<uint8_t>(1), std::length_error);
}

TEST(Arena, withoutMemoryHandsOutNothing) {
  Arena arena;
  EXPECT_THROW(arena.take<uint8_t>(1), std::length_error);
}

// Small ones are as long as asked for, to a line; large ones are whole large pages.
TEST(MemoryBlock, isAlignedAndAsLongAsItsPages) {
  const auto address = [](const MemoryBlock& block) { return reinterpret_cast<uintptr_t>(block.get()); };
  const MemoryBlock small(65, 64), large(kLargePage + 1, 64);
  EXPECT_EQ(small.size(), 128u);
  EXPECT_EQ(address(small) % 64, 0u);
  EXPECT_EQ(large.size(), 2 * kLargePage);
  EXPECT_EQ(address(large) % kLargePage, 0u);
  std::fill_n(large.get(), large.size(), std::byte{1});  // all of it can be written
  EXPECT_EQ(MemoryBlock(0, 64).size(), 0u);
}

// A store of a whole block may begin at any item below capacity, and may begin at capacity when nothing is left.
TEST(Columns, paddingHoldsABlockThatBeginsAtTheLastItem) {
  for (size_t capacity = 0; capacity <= kMostItems; ++capacity) {
    EXPECT_GE(paddedItems(capacity), capacity + kColumnPadding) << capacity;
    EXPECT_EQ(paddedItems(capacity) % kColumnPadding, 0u) << capacity;
  }
}

TEST(Columns, bindFillsExactlyThePlannedMemoryWithZeros) {
  for (size_t capacity = 0; capacity <= kMostItems; ++capacity) {
    Mixed mixed;
    Arena arena(mixed.bytes(capacity));
    mixed.bind(arena, capacity);
    EXPECT_EQ(arena.used(), mixed.bytes(capacity));
    EXPECT_EQ(mixed.capacity(), capacity);
    EXPECT_EQ(mixed.size, 0u);
    EXPECT_TRUE(aligned(mixed.small) && aligned(mixed.large) && aligned(mixed.word));
    for (size_t i = 0; i < paddedItems(capacity); ++i) {
      ASSERT_EQ(mixed.small[i], 0.0f) << capacity << " " << i;
      ASSERT_EQ(mixed.large[i], 0.0) << capacity << " " << i;
      ASSERT_EQ(mixed.word[i], 0u) << capacity << " " << i;
    }
  }
}

// Writing one column to the last item of its padding must not show in another.
TEST(Columns, doNotOverlap) {
  Mixed mixed;
  Arena arena(mixed.bytes(kMostItems));
  mixed.bind(arena, kMostItems);
  for (size_t i = 0; i < paddedItems(kMostItems); ++i) {
    mixed.small[i] = 1;
    mixed.large[i] = 2;
    mixed.word[i] = 3;
  }
  for (size_t i = 0; i < paddedItems(kMostItems); ++i) {
    ASSERT_EQ(mixed.small[i], 1.0f);
    ASSERT_EQ(mixed.large[i], 2.0);
    ASSERT_EQ(mixed.word[i], 3u);
  }
}

TEST(Columns, claimReturnsTheFirstNewItemUntilTheCapacity) {
  for (size_t capacity = 0; capacity <= kMostItems; ++capacity) {
    Mixed mixed;
    Arena arena(mixed.bytes(capacity));
    mixed.bind(arena, capacity);
    for (size_t i = 0; i < capacity; ++i) ASSERT_EQ(mixed.claim(1), i);
    EXPECT_EQ(mixed.size, capacity);
    EXPECT_EQ(mixed.claim(0), capacity);
    EXPECT_THROW(mixed.claim(1), std::length_error);
    EXPECT_EQ(mixed.size, capacity) << "a refused claim leaves the queue as it was";
  }
}

TEST(Columns, claimOfAWholeQueueIsRefusedByOneTooMany) {
  Mixed mixed;
  Arena arena(mixed.bytes(kMostItems));
  mixed.bind(arena, kMostItems);
  EXPECT_THROW(mixed.claim(kMostItems + 1), std::length_error);
  EXPECT_THROW(mixed.claim(SIZE_MAX), std::length_error);
  EXPECT_EQ(mixed.claim(kMostItems), 0u);
}

TEST(Columns, bindToTooSmallAnArenaIsRefused) {
  Mixed mixed;
  Arena arena(mixed.bytes(kMostItems) - 1);
  EXPECT_THROW(mixed.bind(arena, kMostItems), std::length_error);
}

TEST(Columns, droppedColumnsCostNothing) {
  Mixed mixed;
  EXPECT_EQ(mixed.bytesPerItem(), 16u);
  const size_t whole = mixed.bytes(kMostItems);
  mixed.large.drop();
  EXPECT_EQ(mixed.bytesPerItem(), 8u);
  EXPECT_EQ(whole - mixed.bytes(kMostItems), paddedItems(kMostItems) * sizeof(double));
  Arena arena(mixed.bytes(kMostItems));
  mixed.bind(arena, kMostItems);
  EXPECT_FALSE(mixed.large.needed());
  EXPECT_EQ(static_cast<double*>(mixed.large), nullptr);
  EXPECT_NE(static_cast<float*>(mixed.small), nullptr);
}

// ---- the wave -------------------------------------------------------------------------------------------------------

constexpr ColumnNeeds kPlainest{.shadingNormals = false,
                                .textures = false,
                                .normalMaps = false,
                                .tangents = false,
                                .rouletteScale = false,
                                .connections = false,
                                .bsdfOrder = false,
                                .splats = false,
                                .visibility = false};

// Every queue of a wave has the wave's capacity and columns of its own.
template <class Queue>
void expectBound(Queue& queue, size_t capacity) {
  EXPECT_EQ(queue.capacity(), capacity);
  std::apply(
      [](auto&... column) {
        const bool bound[] = {(column.needed() ? column != nullptr && aligned(column) : column == nullptr)...};
        for (const bool b : bound) EXPECT_TRUE(b);
      },
      queue.all());
}

template <class S>
class WaveTest : public testing::Test {};
using StorageTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(WaveTest, StorageTypes);

TYPED_TEST(WaveTest, bindsEveryQueueForEveryNeed) {
  for (unsigned needs = 0; needs < 64; ++needs) {
    for (const size_t capacity : {1u, 15u, 16u, 17u, 2048u}) {
      Wave<TypeParam> wave(capacity, {.shadingNormals = (needs & 1) != 0,
                                      .textures = (needs & 2) != 0,
                                      .normalMaps = (needs & 16) != 0,
                                      .rouletteScale = (needs & 4) != 0,
                                      .connections = (needs & 8) != 0,
                                      .bsdfOrder = (needs & 32) != 0});
      expectBound(wave.rays, capacity);
      expectBound(wave.hits, capacity);
      expectBound(wave.surfaces, capacity);
      expectBound(wave.paths, capacity);
      expectBound(wave.aside.rays, capacity);
      expectBound(wave.aside.hits, capacity);
      expectBound(wave.aside.surfaces, capacity);
      expectBound(wave.aside.paths, capacity);
      expectBound(wave.shadowRays, capacity);
      expectBound(wave.pairs, capacity);
      expectBound(wave.vertexRows, capacity);
      expectBound(wave.radiance, capacity);
    }
  }
}

TYPED_TEST(WaveTest, eachNeedCostsItsColumns) {
  constexpr size_t kReal = sizeof(TypeParam);
  const size_t plainest = Wave<TypeParam>(16, kPlainest).bytesPerPath();
  const auto extra = [&](auto&& change) {
    ColumnNeeds needs = kPlainest;
    change(needs);
    return Wave<TypeParam>(16, needs).bytesPerPath() - plainest;
  };
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.shadingNormals = true; }), 3 * kReal);
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.textures = true; }), 2 * sizeof(float));
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.normalMaps = true; }), 3 * kReal);
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.tangents = true; }), sizeof(float));
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.rouletteScale = true; }), kReal);
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.visibility = true; }), sizeof(float));
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.connections = true; }),
            kReal + 3 * sizeof(uint32_t) + sizeof(VertexRow<TypeParam>));
  // Position, direction, normal, offset, throughput, dVCM; lane and primitive.
  EXPECT_EQ(extra([](ColumnNeeds& n) { n.bsdfOrder = true; }), 14 * kReal + 2 * sizeof(uint32_t));
}

// The bound that makes a wave of 2048 paths leave most of a core's L2 to the scene.
TEST(WaveMemory, plainestWaveIsAtMost128BytesPerPath) { EXPECT_LE(Wave<float>(2048, kPlainest).bytesPerPath(), 128u); }

}  // namespace
}  // namespace wavecrest
