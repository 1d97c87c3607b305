// Light vertices of a whole iteration sorted by place, for range searches of one fixed radius.
//
// A hashed grid of cells somewhat wider than the search's diameter: a query touches two cells along each axis. The
// bucket of a cell is a hash of its y and z plus its x, so the two cells along x are neighbouring buckets and a query
// reads four runs of photons. Buckets may mix cells; a search compares each photon's own cell, so none counts twice.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/columns/light_vertices.h"

namespace wavecrest {

// What merging reads of a light vertex. A record, not columns: searches come to photons in no order, and in float one
// photon is one cache line.
template <class S>
struct alignas(64) PhotonRecord {
  S position[3];
  S direction[3];  // back along the light path
  S normal[3];
  S power[3];  // throughput over the cosine to the normal of the direction
  S dVCM, dVM;
  uint32_t depth;
  uint32_t bucket;
};
static_assert(sizeof(PhotonRecord<float>) == 64);

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
  const PhotonRecord<S>* photons = nullptr;  // by bucket, within a bucket by (wave, depth, lane)
  size_t size = 0;
  PhotonGrid<S> grid;
  // The photons of buckets b and b + 1 are those from bucketStart[b] up to bucketStart[b + 2]; after the last bucket
  // there is an empty one.
  std::vector<uint32_t> bucketStart;

  // Runs body(i) for i in [0, count), in any order and on any threads.
  using ForEach = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

  // Sorts the vertices of all stores. radius: of the searches that will follow. The result does not depend on how
  // forEach spreads the work.
  void build(std::span<LightStore<S>* const> stores, double radius, const ForEach& forEach);

  size_t bytes() const;
  // The same for a map of so many photons.
  static size_t bytesFor(size_t count);

 private:
  using Stores = std::span<LightStore<S>* const>;
  void placeGrid(Stores stores, double radius, const ForEach& forEach);
  void countBuckets(Stores stores, const ForEach& forEach);
  void dealToPartitions(Stores stores, const ForEach& forEach);
  void sortPartition(size_t partition, size_t storeCount);

  size_t capacity_ = 0;
  PhotonRecord<S>* records_ = nullptr;
  std::vector<uint32_t> buckets_;    // of each light vertex, store by store
  std::vector<uint32_t> offsets_;    // of each (partition, store)
  std::vector<size_t> firstVertex_;  // of each store
  Arena arena_;
};

}  // namespace wavecrest
