// Light vertices of a whole iteration sorted by place, for range searches of one fixed radius.
//
// A hashed grid (photon_grid.h): a query touches one or two cells along each axis. The bucket of a cell is a hash of
// its y and z plus its x, so the two cells along x are neighbouring buckets and a query reads one to four runs of
// photons. Buckets may mix cells; a search compares each photon's own cell, so none counts twice. Where photons are few
// for the radius the cells are wider: a search then looks at one more photon now and then, and at fewer buckets always.
//
// What is sorted is eight bytes a photon: about where it is, which tells most of those out of reach from the others,
// and where its row is. Rows stay in the light stores, in the order in which light paths left them. Moving them costs
// more than the searches that find a photon save.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/columns/light_vertices.h"
#include "kernels/columns/photon_grid.h"

namespace wavecrest {

// A photon's place, and its row: that of vertex (photon & (2^storeShift - 1)) of store (photon >> storeShift).
struct alignas(8) PhotonKey {
  uint32_t place;
  uint32_t photon;
};

template <class S>
struct PhotonMap {
  const PhotonKey* keys = nullptr;  // by bucket, within a bucket by (wave, depth, place in the wave)
  size_t size = 0;
  PhotonGrid<S> grid;
  uint32_t bucketMask = 0;                // buckets - 1, a power of two less one
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

  // Sorts the vertices of all stores, which must stay as they are while the map is searched. `over`: the grid with
  // which they were stored. The result does not depend on how forEach spreads the work. Throws std::length_error where
  // 32 bits are too few for the vertices.
  void build(std::span<LightStore<S>* const> stores, const PhotonGrid<S>& over, const ForEach& forEach);

  // The same in parts, for a caller with a schedule of its own: prepare, then the steps one after the other. The tasks
  // of a step may run in any order and on any threads.
  struct BuildStep {
    size_t tasks;
    void (PhotonMap::*run)(size_t task);
  };
  void prepare(std::span<LightStore<S>* const> stores, const PhotonGrid<S>& over);
  // Of a map over so many stores.
  static std::vector<BuildStep> buildSteps(size_t stores);

  size_t bytes() const;
  // The same for a map of so many photons.
  static size_t bytesFor(size_t count);

 private:
  static size_t arenaBytes(size_t capacity);
  void reserve(size_t count);
  // The steps. A task counts or deals the vertices of some stores.
  void countPartitions(size_t task);
  void addUpCounts(size_t);
  void dealToPartitions(size_t task);
  void sortPartition(size_t partition);

  std::vector<LightStore<S>*> stores_;
  size_t capacity_ = 0;
  PhotonKey* keys_ = nullptr;
  PhotonKey* dealt_ = nullptr;        // by partition
  uint32_t* dealtBuckets_ = nullptr;  // of each of these
  uint32_t* starts_ = nullptr;
  std::vector<uint32_t> offsets_;  // of each (partition, store), where its first photon goes
  Arena arena_;
};

}  // namespace wavecrest
