#include "kernels/merge/photon_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace wavecrest {
namespace {

// Entries are first dealt to this many partitions by the top bits of the bucket, then sorted within each: both passes
// stay within a core's caches for up to some ten million photons.
constexpr uint32_t kPartitions = 256;
constexpr uint32_t kMinBuckets = 1u << 12;

// Iterations differ a little in how many photons they have: some room, so that memory is allocated once.
constexpr size_t withRoom(size_t count) { return count + count / 16; }

constexpr size_t bucketCount(size_t photons) { return std::max<size_t>(std::bit_ceil(photons), kMinBuckets); }

template <class S>
struct Bounds {
  std::array<S, 3> low, high;
};

template <class S>
Bounds<S> boundsOf(const LightVertices<S>& v) {
  constexpr S kInfinity = std::numeric_limits<S>::infinity();
  Bounds<S> bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const S* const columns[3] = {v.positionX, v.positionY, v.positionZ};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < v.size; ++i) {
      bounds.low[axis] = std::min(bounds.low[axis], columns[axis][i]);
      bounds.high[axis] = std::max(bounds.high[axis], columns[axis][i]);
    }
  }
  return bounds;
}

template <class S>
uint32_t bucketOf(const PhotonGrid<S>& grid, S x, S y, S z) {
  const auto cell = [&](S p, size_t axis) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::floor((p - grid.origin[axis]) * grid.inverseCell)));
  };
  return (PhotonGrid<S>::hash(cell(y, 1), cell(z, 2)) + cell(x, 0)) & grid.bucketMask;
}

}  // namespace

template <class S>
void PhotonMap<S>::placeGrid(std::span<LightStore<S>* const> stores, double radius, size_t total,
                             const ForEach& forEach) {
  std::vector<Bounds<S>> bounds(stores.size());
  forEach(stores.size(), [&](size_t i) { bounds[i] = boundsOf(stores[i]->vertices); });
  // A shade wider than the diameter, so that rounding cannot put the far end of a query into a third cell.
  double cell = 2 * radius * (1 + 1e-4);
  for (size_t axis = 0; axis < 3; ++axis) {
    S low = std::numeric_limits<S>::infinity(), high = -low;
    for (const Bounds<S>& b : bounds) {
      low = std::min(low, b.low[axis]);
      high = std::max(high, b.high[axis]);
    }
    // Two cells of margin below keep every cell that a query touches at or above zero.
    grid.origin[axis] = low - static_cast<S>(4 * radius);
    // Cell numbers stay exact in S and within 21 bits: a search of smaller radius than that reads somewhat more
    // photons.
    cell = std::max(cell, (static_cast<double>(high) - low) / (1 << 21));
  }
  grid.inverseCell = static_cast<S>(1 / cell);
  grid.bucketMask = static_cast<uint32_t>(bucketCount(total)) - 1;
}

template <class S>
void PhotonMap<S>::sortEntries(std::span<LightStore<S>* const> stores, size_t total, const ForEach& forEach) {
  const uint32_t buckets = grid.bucketMask + 1;
  const uint32_t perPartition = buckets / kPartitions;
  const size_t storeCount = stores.size();
  std::vector<size_t> firstEntry(storeCount + 1, 0);
  for (size_t i = 0; i < storeCount; ++i) firstEntry[i + 1] = firstEntry[i] + stores[i]->vertices.size;
  entries_.resize(total);
  sorted_.resize(total);
  offsets_.assign(kPartitions * storeCount + 1, 0);
  bucketStart.resize(buckets + 1);

  // Bucket of each vertex, and how many of each store fall into each partition.
  forEach(storeCount, [&](size_t i) {
    const LightVertices<S>& v = stores[i]->vertices;
    for (size_t k = 0; k < v.size; ++k) {
      const uint32_t bucket = bucketOf(grid, v.positionX[k], v.positionY[k], v.positionZ[k]);
      entries_[firstEntry[i] + k] = {bucket, static_cast<uint32_t>(i), static_cast<uint32_t>(k)};
      ++offsets_[(bucket / perPartition) * storeCount + i + 1];
    }
  });
  for (size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];

  // Deal: store by store into its own part of each partition, so the order is the same whoever does it.
  forEach(storeCount, [&](size_t i) {
    std::array<uint32_t, kPartitions> next;
    for (uint32_t p = 0; p < kPartitions; ++p) next[p] = offsets_[p * storeCount + i];
    for (size_t k = firstEntry[i]; k < firstEntry[i + 1]; ++k)
      sorted_[next[entries_[k].bucket / perPartition]++] = entries_[k];
  });

  // Within a partition: a stable counting sort by bucket.
  forEach(kPartitions, [&](size_t p) {
    const uint32_t first = offsets_[p * storeCount], last = offsets_[(p + 1) * storeCount];
    const uint32_t firstBucket = static_cast<uint32_t>(p) * perPartition;
    std::vector<uint32_t> next(perPartition + 1, 0);
    for (uint32_t k = first; k < last; ++k) ++next[sorted_[k].bucket - firstBucket + 1];
    next[0] = first;
    for (uint32_t b = 0; b < perPartition; ++b) next[b + 1] += next[b];
    std::copy(next.begin(), next.end() - 1, bucketStart.begin() + firstBucket);
    for (uint32_t k = first; k < last; ++k) entries_[next[sorted_[k].bucket - firstBucket]++] = sorted_[k];
    copyPhotons(stores, first, last);
  });
  bucketStart[buckets] = static_cast<uint32_t>(total);
}

template <class S>
void PhotonMap<S>::copyPhotons(std::span<LightStore<S>* const> stores, size_t first, size_t last) {
  for (size_t k = first; k < last; ++k) {
    const LightVertices<S>& v = stores[entries_[k].store]->vertices;
    const uint32_t i = entries_[k].vertex;
    photons.positionX[k] = v.positionX[i];
    photons.positionY[k] = v.positionY[i];
    photons.positionZ[k] = v.positionZ[i];
    photons.directionX[k] = v.fixX[i];
    photons.directionY[k] = v.fixY[i];
    photons.directionZ[k] = v.fixZ[i];
    photons.normalX[k] = v.normalX[i];
    photons.normalY[k] = v.normalY[i];
    photons.normalZ[k] = v.normalZ[i];
    const S cosine = std::abs(v.fixX[i] * v.normalX[i] + v.fixY[i] * v.normalY[i] + v.fixZ[i] * v.normalZ[i]);
    // Directions within the surface carry nothing that a merge could use (METHODS 3.9).
    const S scale = cosine > static_cast<S>(1e-6) ? 1 / cosine : 0;
    photons.red[k] = v.throughputR[i] * scale;
    photons.green[k] = v.throughputG[i] * scale;
    photons.blue[k] = v.throughputB[i] * scale;
    photons.dVCM[k] = v.dVCM[i];
    photons.dVM[k] = v.dVM[i];
    photons.depth[k] = v.depth[i];
  }
}

template <class S>
void PhotonMap<S>::build(std::span<LightStore<S>* const> stores, double radius, const ForEach& forEach) {
  size_t total = 0;
  for (const LightStore<S>* store : stores) total += store->vertices.size;
  if (total > photons.capacity()) {
    arena_ = Arena();  // first, so that the old and the new are not there at once
    arena_ = Arena(photons.bytes(withRoom(total)));
    photons.bind(arena_, withRoom(total));
    for (std::vector<Entry>* list : {&entries_, &sorted_}) {
      *list = {};
      list->reserve(withRoom(total));
    }
  }
  photons.size = total;
  if (total == 0) {
    grid = {.origin = {}, .inverseCell = 1, .bucketMask = kMinBuckets - 1};
    bucketStart.assign(kMinBuckets + 1, 0);
    return;
  }
  placeGrid(stores, radius, total, forEach);
  sortEntries(stores, total, forEach);
}

template <class S>
size_t PhotonMap<S>::bytesFor(size_t count) {
  const size_t room = withRoom(count);
  return Photons<S>().bytes(room) + (bucketCount(count) + 1) * sizeof(uint32_t) + 2 * room * sizeof(Entry);
}

template <class S>
size_t PhotonMap<S>::bytes() const {
  return photons.bytes(photons.capacity()) + bucketStart.capacity() * sizeof(uint32_t) +
         (entries_.capacity() + sorted_.capacity()) * sizeof(Entry);
}

template struct PhotonMap<float>;
template struct PhotonMap<double>;

}  // namespace wavecrest
