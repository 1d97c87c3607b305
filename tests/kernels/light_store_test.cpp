// LightStore: memory of its own and of others, and what stays when it grows.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "kernels/columns/light_vertices.h"

namespace wavecrest {
namespace {

constexpr size_t kLanesOfStore = 32;
constexpr ColumnNeeds kNeeds{};

// Writes vertices [first, first + count), each with a number of its own in every kind of column.
void fill(LightStore<float>& store, size_t first, size_t count) {
  const size_t at = store.vertices.claim(count);
  ASSERT_EQ(at, first);
  for (size_t i = first; i < first + count; ++i) {
    store.vertices.place[i] = static_cast<uint32_t>(i) + 7;
    store.vertices.row[i].dVC = static_cast<float>(i) + 0.25f;
    store.vertices.lane[i] = static_cast<uint32_t>(i);
    store.vertices.row[i].position[0] = static_cast<float>(i) + 0.5f;
  }
}
void expectFilled(const LightStore<float>& store, size_t count) {
  ASSERT_EQ(store.vertices.size, count);
  for (size_t i = 0; i < count; ++i) {
    EXPECT_EQ(store.vertices.place[i], i + 7);
    EXPECT_EQ(store.vertices.row[i].dVC, static_cast<float>(i) + 0.25f);
    EXPECT_EQ(store.vertices.lane[i], i);
    EXPECT_EQ(store.vertices.row[i].position[0], static_cast<float>(i) + 0.5f);
  }
}

TEST(LightStore, storesSideBySideKeepApart) {
  constexpr size_t kStores = 5, kCapacity = 100;
  std::vector<std::unique_ptr<LightStore<float>>> stores;
  for (size_t k = 0; k < kStores; ++k) stores.push_back(std::make_unique<LightStore<float>>(kLanesOfStore, kNeeds));
  Arena shared(kStores * stores[0]->arenaBytes(kCapacity));
  for (auto& store : stores) store->reserve(kCapacity, shared);
  EXPECT_EQ(shared.used(), kStores * stores[0]->arenaBytes(kCapacity)) << "all of it, and no more";
  for (auto& store : stores) {
    store->beginDepth(kCapacity);
    fill(*store, 0, kCapacity);
  }
  for (auto& store : stores) {
    expectFilled(*store, kCapacity);
    EXPECT_EQ(store->bytes(), store->bytesFor(kCapacity));
  }
}

TEST(LightStore, thatOutgrowsSharedMemoryKeepsItsVerticesAndLeavesOthersAlone) {
  LightStore<float> small(kLanesOfStore, kNeeds), other(kLanesOfStore, kNeeds);
  Arena shared(small.arenaBytes(50) + other.arenaBytes(50));
  small.reserve(50, shared);
  other.reserve(50, shared);
  other.beginDepth(50);
  fill(other, 0, 50);
  small.beginDepth(50);
  fill(small, 0, 40);
  small.beginDepth(60);
  fill(small, 40, 60);
  expectFilled(small, 100);
  expectFilled(other, 50);
  EXPECT_GE(small.vertices.capacity(), 100u);
  EXPECT_EQ(small.bytes(), small.bytesFor(small.vertices.capacity()) + small.arenaBytes(50))
      << "what it took and has left counts";
  const size_t held = small.bytes();
  small.clear();
  small.reserve(50, shared);
  EXPECT_EQ(small.bytes(), held) << "it has more than that already";
}

// Paths of three stores, counted around after the last, whose vertices are in no order of lanes.
TEST(LightStore, collectsTheVerticesOfARangeOfPathsWhateverTheirOrder) {
  constexpr size_t kStores = 3, kPaths = 80;  // the last store has 16 of its 32
  std::vector<std::unique_ptr<LightStore<float>>> stores;
  const auto reaches = [](size_t path, uint32_t depth) { return depth <= path % 4; };
  for (size_t k = 0; k < kStores; ++k) {
    LightStore<float>& store = *stores.emplace_back(std::make_unique<LightStore<float>>(kLanesOfStore, kNeeds));
    for (uint32_t depth = 1; depth <= 3; ++depth) {
      store.beginDepth(kLanesOfStore);
      size_t diffuse = 0;  // odd ones, which come first
      for (const size_t parity : {1u, 0u}) {
        for (size_t lane = parity; lane < kLanesOfStore; lane += 2) {
          const size_t path = k * kLanesOfStore + lane;
          if (path >= kPaths || !reaches(path, depth)) continue;
          const size_t at = store.vertices.claim(1);
          store.vertices.lane[at] = static_cast<uint32_t>(lane);
          store.vertices.row[at].dVC = static_cast<float>(100 * depth + path);
        }
        if (parity == 1) diffuse = store.vertices.size - store.firstOf(depth);
      }
      store.link(store.vertices.size - store.firstOf(depth), diffuse);
    }
  }
  LightStore<float> collected(kLanesOfStore, kNeeds);
  for (const size_t first : {0u, 5u, 40u, 70u}) {
    for (const size_t used : {1u, 17u, 32u}) {
      collected.collect(stores, kPaths, first, used);
      for (uint32_t lane = 0; lane < used; ++lane) {
        const size_t path = (first + lane) % kPaths;
        uint32_t link = collected.firstOfLane()[lane];
        for (uint32_t depth = 1; depth <= 3; ++depth) {
          if (!reaches(path, depth)) continue;
          ASSERT_NE(link, kNoIndex);
          const uint32_t vertex = link & kLinkIndex;
          EXPECT_EQ(collected.vertices.row[vertex].dVC, static_cast<float>(100 * depth + path));
          EXPECT_EQ((link & kOtherLink) == 0, path % 2 == 1);
          link = collected.vertices.next[vertex];
        }
        EXPECT_EQ(link, kNoIndex);
      }
      for (uint32_t depth = 1; depth <= 3; ++depth) {
        std::map<uint32_t, float> expected, found;
        for (uint32_t lane = 0; lane < used; ++lane) {
          const size_t path = (first + lane) % kPaths;
          if (reaches(path, depth)) expected[lane] = static_cast<float>(100 * depth + path);
        }
        for (size_t i = collected.firstOf(depth); i < collected.firstOf(depth + 1); ++i) {
          EXPECT_TRUE(found.emplace(collected.vertices.lane[i], collected.vertices.row[i].dVC).second);
        }
        EXPECT_EQ(found, expected) << "depth " << depth << ", " << used << " from " << first;
      }
    }
  }
}

}  // namespace
}  // namespace wavecrest
