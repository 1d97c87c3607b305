#include "kernels/merge/photon_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/simd/stream_store.h"

namespace wavecrest {
namespace {

// Photons are first dealt to this many partitions by the top bits of the bucket, then sorted within each: the first
// pass writes as many streams of whole cache lines past the caches, the second stays within a core's for up to some ten
// million photons.
constexpr uint32_t kPartitions = 256;
constexpr uint32_t kMinBuckets = 1u << 12;

// Iterations differ a little in how many photons they have: some room, so that memory is allocated once.
constexpr size_t withRoom(size_t count) { return count + count / 16; }

// About every third bucket is filled: searches of a hashed grid read what else is in their buckets.
constexpr size_t bucketCount(size_t photons) { return std::max<size_t>(std::bit_ceil(2 * photons), kMinBuckets); }

template <class S>
struct Bounds {
  std::array<S, 3> low, high;
};

template <class S>
Bounds<S> boundsOf(const LightVertices<S>& v) {
  constexpr S kInfinity = std::numeric_limits<S>::infinity();
  constexpr size_t kAbreast = 16;  // independent minima and maxima, which the compiler keeps in registers
  Bounds<S> bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const S* const columns[3] = {v.positionX, v.positionY, v.positionZ};
  for (size_t axis = 0; axis < 3; ++axis) {
    const S* const column = columns[axis];
    std::array<S, kAbreast> low, high;
    low.fill(kInfinity);
    high.fill(-kInfinity);
    const size_t whole = v.size / kAbreast * kAbreast;
    for (size_t i = 0; i < whole; i += kAbreast) {
      for (size_t k = 0; k < kAbreast; ++k) {
        low[k] = std::min(low[k], column[i + k]);
        high[k] = std::max(high[k], column[i + k]);
      }
    }
    for (size_t i = whole; i < v.size; ++i) {
      low[0] = std::min(low[0], column[i]);
      high[0] = std::max(high[0], column[i]);
    }
    bounds.low[axis] = *std::min_element(low.begin(), low.end());
    bounds.high[axis] = *std::max_element(high.begin(), high.end());
  }
  return bounds;
}

template <class S>
uint32_t bucketOf(const PhotonGrid<S>& grid, S x, S y, S z) {
  // The origin is below all photons: truncation is floor, and one instruction.
  const auto cell = [&](S p, size_t axis) {
    return static_cast<uint32_t>(static_cast<int32_t>((p - grid.origin[axis]) * grid.inverseCell));
  };
  return (PhotonGrid<S>::hash(cell(y, 1), cell(z, 2)) + cell(x, 0)) & grid.bucketMask;
}

template <class S>
PhotonRecord<S> recordOf(const LightVertices<S>& v, size_t i, uint32_t bucket) {
  const S cosine = std::abs(v.fixX[i] * v.normalX[i] + v.fixY[i] * v.normalY[i] + v.fixZ[i] * v.normalZ[i]);
  // Directions within the surface carry nothing that a merge could use (METHODS 3.9).
  const S scale = cosine > static_cast<S>(1e-6) ? 1 / cosine : 0;
  return {.position = {v.positionX[i], v.positionY[i], v.positionZ[i]},
          .direction = {v.fixX[i], v.fixY[i], v.fixZ[i]},
          .normal = {v.normalX[i], v.normalY[i], v.normalZ[i]},
          .power = {v.throughputR[i] * scale, v.throughputG[i] * scale, v.throughputB[i] * scale},
          .dVCM = v.dVCM[i],
          .dVM = v.dVM[i],
          .depth = v.depth[i],
          .bucket = bucket};
}

}  // namespace

template <class S>
void PhotonMap<S>::placeGrid(Stores stores, double radius, const ForEach& forEach) {
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
  grid.bucketMask = static_cast<uint32_t>(bucketCount(size)) - 1;
}

template <class S>
void PhotonMap<S>::countBuckets(Stores stores, const ForEach& forEach) {
  const int partitionShift = std::countr_zero((grid.bucketMask + 1) / kPartitions);
  const size_t storeCount = stores.size();
  offsets_.assign(kPartitions * storeCount + 1, 0);
  forEach(storeCount, [&](size_t i) {
    const LightVertices<S>& v = stores[i]->vertices;
    std::array<uint32_t, kPartitions> counts{};
    for (size_t k = 0; k < v.size; ++k) {
      const uint32_t bucket = bucketOf(grid, v.positionX[k], v.positionY[k], v.positionZ[k]);
      buckets_[firstVertex_[i] + k] = bucket;
      ++counts[bucket >> partitionShift];
    }
    for (uint32_t p = 0; p < kPartitions; ++p) offsets_[p * storeCount + i + 1] = counts[p];
  });
  for (size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
}

// Store by store into its own part of each partition, so the order is the same whoever does it.
template <class S>
void PhotonMap<S>::dealToPartitions(Stores stores, const ForEach& forEach) {
  const int partitionShift = std::countr_zero((grid.bucketMask + 1) / kPartitions);
  const size_t storeCount = stores.size();
  forEach(storeCount, [&](size_t i) {
    const LightVertices<S>& v = stores[i]->vertices;
    std::array<uint32_t, kPartitions> next;
    for (uint32_t p = 0; p < kPartitions; ++p) next[p] = offsets_[p * storeCount + i];
    for (size_t k = 0; k < v.size; ++k) {
      const uint32_t bucket = buckets_[firstVertex_[i] + k];
      streamStore(recordOf(v, k, bucket), &records_[next[bucket >> partitionShift]++]);
    }
    streamFence();
  });
}

// A stable counting sort by bucket. Records change places where they are: the partition is in the cache by then, and a
// second copy of all photons would cost more time than the sort.
template <class S>
void PhotonMap<S>::sortPartition(size_t partition, size_t storeCount) {
  const uint32_t perPartition = (grid.bucketMask + 1) / kPartitions;
  const uint32_t first = offsets_[partition * storeCount], count = offsets_[(partition + 1) * storeCount] - first;
  const uint32_t firstBucket = static_cast<uint32_t>(partition) * perPartition;
  PhotonRecord<S>* const records = records_ + first;
  std::vector<uint32_t> next(perPartition + 1, 0), source(count);
  for (uint32_t k = 0; k < count; ++k) ++next[records[k].bucket - firstBucket + 1];
  for (uint32_t b = 0; b < perPartition; ++b) {
    bucketStart[firstBucket + b] = first + next[b];
    next[b + 1] += next[b];
  }
  for (uint32_t k = 0; k < count; ++k) source[next[records[k].bucket - firstBucket]++] = k;
  // Cycle by cycle: the first record steps aside, each place takes the one that belongs there.
  for (uint32_t k = 0; k < count; ++k) {
    if (source[k] == k) continue;
    const PhotonRecord<S> aside = records[k];
    uint32_t place = k;
    while (source[place] != k) {
      records[place] = records[source[place]];
      place = std::exchange(source[place], place);
    }
    records[place] = aside;
    source[place] = place;
  }
}

template <class S>
void PhotonMap<S>::build(Stores stores, double radius, const ForEach& forEach) {
  firstVertex_.assign(1, 0);
  for (const LightStore<S>* store : stores) firstVertex_.push_back(firstVertex_.back() + store->vertices.size);
  size = firstVertex_.back();
  if (size > capacity_) {
    capacity_ = withRoom(size);
    arena_ = Arena();  // first, so that the old and the new are not there at once
    arena_ = Arena(capacity_ * sizeof(PhotonRecord<S>));
    records_ = arena_.take<PhotonRecord<S>>(capacity_);
    buckets_ = {};
    buckets_.resize(capacity_);
  }
  photons = records_;
  const size_t buckets = bucketCount(size);
  bucketStart.resize(buckets + 2);
  if (size == 0) {
    grid = {.origin = {}, .inverseCell = 1, .bucketMask = static_cast<uint32_t>(buckets) - 1};
    std::fill(bucketStart.begin(), bucketStart.end(), 0);
    return;
  }
  placeGrid(stores, radius, forEach);
  countBuckets(stores, forEach);
  dealToPartitions(stores, forEach);
  forEach(kPartitions, [&](size_t partition) { sortPartition(partition, stores.size()); });
  bucketStart[buckets] = bucketStart[buckets + 1] = static_cast<uint32_t>(size);
}

template <class S>
size_t PhotonMap<S>::bytesFor(size_t count) {
  return withRoom(count) * (sizeof(PhotonRecord<S>) + sizeof(uint32_t)) + (bucketCount(count) + 2) * sizeof(uint32_t);
}

template <class S>
size_t PhotonMap<S>::bytes() const {
  return capacity_ * (sizeof(PhotonRecord<S>) + sizeof(uint32_t)) + bucketStart.capacity() * sizeof(uint32_t);
}

template struct PhotonMap<float>;
template struct PhotonMap<double>;

}  // namespace wavecrest
