// Light vertices of a whole iteration sorted by place, for range searches of one fixed radius.
//
// A hashed grid of cells at least as wide as the search's diameter: a query touches one or two cells along each axis.
// The bucket of a cell is a hash of its y and z plus its x, so the two cells along x are neighbouring buckets and a
// query reads one to four runs of photons. Buckets may mix cells; a search compares each photon's own cell, so none
// counts twice. Where photons are few for the radius the cells are wider: a search then looks at one more photon now
// and then, and at fewer buckets always.
//
// Only positions are sorted; the other fields stay in the rows of the light stores, in the order in which light
// paths left them. Moving them costs more than the searches that find a photon save.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/columns/light_vertices.h"

namespace wavecrest {

// Where a photon is, and its row: that of vertex (photon & (2^storeShift - 1)) of store (photon >> storeShift).
template <class S>
struct alignas(4 * sizeof(S)) PhotonKey {
  S position[3];
  uint32_t photon;
};
static_assert(sizeof(PhotonKey<float>) == 16);

// The grid that cells are counted in. cell = floor((position - origin) * inverseCell), in S without contraction, so
// that build and search agree to the bit.
template <class S>
struct PhotonGrid {
  S origin[3]{};
  S inverseCell = 0;
  uint32_t bucketMask = 0;  // buckets - 1, a power of two less one

  static constexpr uint32_t hash(uint32_t y, uint32_t z) {
    uint32_t h = y * 0x9e3779b1u ^ z * 0x85ebca77u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ h >> 12;
  }
};

template <class S>
struct PhotonMap {
  const PhotonKey<S>* keys = nullptr;  // by bucket, within a bucket by (wave, depth, lane)
  size_t size = 0;
  PhotonGrid<S> grid;
  std::vector<const VertexRow<S>*> rows;  // of each store
  uint32_t storeShift = 0;
  // The photons of buckets b and b + 1 are those from bucketStart[b] up to bucketStart[b + 2]; after the last bucket
  // there are some empty ones, because searches read four entries at once.
  const uint32_t* bucketStart = nullptr;

  // Runs body(i) for i in [0, count), in any order and on any threads.
  using ForEach = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

  const VertexRow<S>& rowOf(uint32_t photon) const {
    return rows[photon >> storeShift][photon & ((1u << storeShift) - 1)];
  }

  // Sorts the vertices of all stores, which must stay as they are while the map is searched. radius: of the searches
  // that will follow. The result does not depend on how forEach spreads the work.
  void build(std::span<LightStore<S>* const> stores, double radius, const ForEach& forEach);

  size_t bytes() const;
  // The same for a map of so many photons.
  static size_t bytesFor(size_t count);

 private:
  using Stores = std::span<LightStore<S>* const>;
  static size_t arenaBytes(size_t capacity);
  void reserve(size_t count);
  void placeGrid(Stores stores, double radius, const ForEach& forEach);
  void countBuckets(Stores stores, const ForEach& forEach);
  void dealToPartitions(Stores stores, const ForEach& forEach);
  void sortPartition(size_t partition, size_t storeCount);

  size_t capacity_ = 0;
  PhotonKey<S>* keys_ = nullptr;
  PhotonKey<S>* dealt_ = nullptr;     // by partition
  uint32_t* dealtBuckets_ = nullptr;  // of each of these
  uint32_t* buckets_ = nullptr;       // of each light vertex, store by store
  uint32_t* starts_ = nullptr;
  std::vector<uint32_t> offsets_;    // of each (partition, store)
  std::vector<size_t> firstVertex_;  // of each store
  Arena arena_;
};

}  // namespace wavecrest
