// LightStore: memory of its own and of others, and what stays when it grows.
#include <gtest/gtest.h>

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
    store.vertices.row[i].behind = static_cast<float>(i) + 0.25f;
    store.vertices.lane[i] = static_cast<uint32_t>(i);
    store.vertices.row[i].position[0] = static_cast<float>(i) + 0.5f;
  }
}
void expectFilled(const LightStore<float>& store, size_t count) {
  ASSERT_EQ(store.vertices.size, count);
  for (size_t i = 0; i < count; ++i) {
    EXPECT_EQ(store.vertices.place[i], i + 7);
    EXPECT_EQ(store.vertices.row[i].behind, static_cast<float>(i) + 0.25f);
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

}  // namespace
}  // namespace wavecrest
