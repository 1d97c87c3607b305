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

// What merging reads of a light vertex, in the order of buckets and within a bucket of (wave, depth, lane).
template <class S>
struct Photons : Columns<Photons<S>> {
  Column<S> positionX, positionY, positionZ;
  Column<S> directionX, directionY, directionZ;  // back along the light path
  Column<S> normalX, normalY, normalZ;
  Column<S> red, green, blue;  // throughput over the cosine to the normal of the direction
  Column<S> dVCM, dVM;
  Column<uint32_t> depth;
  auto all() {
    return std::tie(positionX, positionY, positionZ, directionX, directionY, directionZ, normalX, normalY, normalZ, red,
                    green, blue, dVCM, dVM, depth);
  }
};

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
  Photons<S> photons;
  PhotonGrid<S> grid;
  std::vector<uint32_t> bucketStart;  // buckets + 1 entries

  // Runs body(i) for i in [0, count), in any order and on any threads.
  using ForEach = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

  // Sorts the vertices of all stores. radius: of the searches that will follow. The result does not depend on how
  // forEach spreads the work.
  void build(std::span<LightStore<S>* const> stores, double radius, const ForEach& forEach);

  size_t bytes() const;
  // The same for a map of so many photons.
  static size_t bytesFor(size_t count);

 private:
  struct Entry {
    uint32_t bucket, store, vertex;
  };

  void placeGrid(std::span<LightStore<S>* const> stores, double radius, size_t total, const ForEach& forEach);
  void sortEntries(std::span<LightStore<S>* const> stores, size_t total, const ForEach& forEach);
  void copyPhotons(std::span<LightStore<S>* const> stores, size_t first, size_t last);

  std::vector<Entry> entries_, sorted_;
  std::vector<uint32_t> offsets_;  // of each (partition, store)
  Arena arena_;
};

}  // namespace wavecrest
