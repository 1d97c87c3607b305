#include "kernels/merge/photon_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace wavecrest {
namespace {

// Photons are first dealt to this many partitions by the top bits of the bucket, then sorted within each: the first
// pass writes as many streams, whose pages are all at hand, the second stays within a core's caches for up to some
// million photons.
constexpr uint32_t kPartitions = 64;
// Each stream's next lines are asked for so many photons before they are written.
constexpr size_t kPhotonsAhead = 8;
// Photons whose buckets are found before they are counted: they are still in the first cache then.
constexpr size_t kCountedAtOnce = 1024;
constexpr uint32_t kMinBuckets = 1u << 12;
// Entries of bucketStart after the last bucket's: searches read four from the bucket on.
constexpr size_t kStartsBeyond = 4;

// Iterations differ a little in how many photons they have: some room, so that memory is allocated once.
constexpr size_t withRoom(size_t count) { return count + count / 16; }

// Where photons are few for the radius, cells are wider than a search. A search looks at (1 + 2r / c)^2 runs and at the
// photons on about (c + 2r)^2 of a surface: with n photons on a unit of area the sum is least at c^3 = k r / n, and k
// is twice what a run costs in photons. Measured: 2.5 and 9 are slower by a percent or two.
constexpr double kTwiceRunInPhotons = 5;

// About every second bucket is filled: searches of a hashed grid read what else is in their buckets, but with more of
// them the table outgrows the caches.
constexpr size_t bucketCount(size_t photons) { return std::max<size_t>(std::bit_ceil(photons), kMinBuckets); }

template <class S>
uint32_t bucketOf(const PhotonGrid<S>& grid, S x, S y, S z) {
  // The origin is below all photons: truncation is floor, and one instruction.
  const auto cell = [&](S p, size_t axis) {
    return static_cast<uint32_t>(static_cast<int32_t>((p - grid.origin[axis]) * grid.inverseCell));
  };
  return (PhotonGrid<S>::hash(cell(y, 1), cell(z, 2)) + cell(x, 0)) & grid.bucketMask;
}

}  // namespace

template <class S>
void PhotonMap<S>::placeGrid(Stores stores, double radius, const ForEach& forEach) {
  forEach(stores.size(), [&](size_t i) { stores[i]->findBounds(); });
  // A shade wider than the diameter, so that rounding cannot put the far end of a query into a third cell.
  double cell = 2 * radius * (1 + 1e-4);
  double extent[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    S low = std::numeric_limits<S>::infinity(), high = -low;
    for (const LightStore<S>* store : stores) {
      low = std::min(low, store->bounds().low[axis]);
      high = std::max(high, store->bounds().high[axis]);
    }
    // A margin below keeps every cell that a query touches at or above zero.
    grid.origin[axis] = low - static_cast<S>(4 * radius);
    extent[axis] = static_cast<double>(high) - low;
    // Cell numbers stay exact in S and within 21 bits: a search of smaller radius than that reads somewhat more
    // photons.
    cell = std::max(cell, extent[axis] / (1 << 21));
  }
  // As if they lay on the sides of the box around them.
  const double sides = 2 * (extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0]);
  cell = std::max(cell, std::cbrt(kTwiceRunInPhotons * radius * sides / static_cast<double>(size)));
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
    // Apart, so that the compiler can do the first with vectors.
    uint32_t* const buckets = buckets_ + firstVertex_[i];
    const PhotonGrid<S> place = grid;
    const S* const x = v.positionX;
    const S* const y = v.positionY;
    const S* const z = v.positionZ;
    for (size_t begin = 0; begin < v.size; begin += kCountedAtOnce) {
      const size_t end = std::min(begin + kCountedAtOnce, v.size);
      for (size_t k = begin; k < end; ++k) buckets[k] = bucketOf(place, x[k], y[k], z[k]);
      for (size_t k = begin; k < end; ++k) ++counts[buckets[k] >> partitionShift];
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
    const uint32_t* const buckets = buckets_ + firstVertex_[i];
    const uint32_t firstPhoton = static_cast<uint32_t>(i) << storeShift;
    std::array<uint32_t, kPartitions> next;
    for (uint32_t p = 0; p < kPartitions; ++p) next[p] = offsets_[p * storeCount + i];
    for (uint32_t k = 0; k < v.size; ++k) {
      const uint32_t place = next[buckets[k] >> partitionShift]++;
      __builtin_prefetch(dealt_ + place + kPhotonsAhead, 1);
      dealt_[place] = {{v.positionX[k], v.positionY[k], v.positionZ[k]}, firstPhoton + k};
      dealtBuckets_[place] = buckets[k];
    }
  });
}

// A stable counting sort by bucket.
template <class S>
void PhotonMap<S>::sortPartition(size_t partition, size_t storeCount) {
  const uint32_t perPartition = (grid.bucketMask + 1) / kPartitions;
  const uint32_t first = offsets_[partition * storeCount], end = offsets_[(partition + 1) * storeCount];
  uint32_t* const start = starts_ + partition * perPartition;
  const uint32_t* const bucket = dealtBuckets_ + first;
  const uint32_t firstBucket = static_cast<uint32_t>(partition) * perPartition, count = end - first;
  // Counts, then a running sum that leaves in start[b] where bucket b ends. Dealing from the last photon to the first
  // moves each end down to where its bucket begins, and keeps the order within it.
  constexpr uint32_t kKeysPerLine = 64 / sizeof(PhotonKey<S>);
  for (uint32_t k = first; k < end; k += kKeysPerLine) __builtin_prefetch(keys_ + k, 1);
  std::fill_n(start, perPartition, 0);
  for (uint32_t k = 0; k < count; ++k) ++start[bucket[k] - firstBucket];
  uint32_t place = first;
  for (uint32_t b = 0; b < perPartition; b += 4) {
    const uint32_t one = start[b], two = one + start[b + 1], three = two + start[b + 2], four = three + start[b + 3];
    start[b] = place + one;
    start[b + 1] = place + two;
    start[b + 2] = place + three;
    start[b + 3] = place + four;
    place += four;
  }
  for (uint32_t k = count; k-- > 0;) keys_[--start[bucket[k] - firstBucket]] = dealt_[first + k];
}

template <class S>
void PhotonMap<S>::reserve(size_t count) {
  if (count <= capacity_) return;
  capacity_ = withRoom(count);
  arena_ = Arena();  // first, so that the old and the new are not there at once
  arena_ = Arena(arenaBytes(capacity_));
  keys_ = arena_.take<PhotonKey<S>>(capacity_);
  dealt_ = arena_.take<PhotonKey<S>>(capacity_);
  dealtBuckets_ = arena_.take<uint32_t>(capacity_);
  buckets_ = arena_.take<uint32_t>(capacity_);
  starts_ = arena_.take<uint32_t>(bucketCount(capacity_) + kStartsBeyond);
  keys = keys_;
  bucketStart = starts_;
}

template <class S>
void PhotonMap<S>::build(Stores stores, double radius, const ForEach& forEach) {
  firstVertex_.assign(1, 0);
  rows.clear();
  size_t largest = 1;
  for (const LightStore<S>* store : stores) {
    firstVertex_.push_back(firstVertex_.back() + store->vertices.size);
    rows.push_back(store->vertices.row);
    largest = std::max(largest, store->vertices.size);
  }
  storeShift = static_cast<uint32_t>(std::bit_width(largest - 1));
  if (stores.size() > (size_t{1} << (32 - storeShift))) {
    throw std::length_error("PhotonMap: more light vertices than 32 bits can tell apart");
  }
  size = firstVertex_.back();
  reserve(std::max<size_t>(size, 1));
  const size_t buckets = bucketCount(size);
  if (size == 0) {
    grid = {.origin = {}, .inverseCell = 1, .bucketMask = static_cast<uint32_t>(buckets) - 1};
    std::fill_n(starts_, buckets + kStartsBeyond, 0);
    return;
  }
  placeGrid(stores, radius, forEach);
  countBuckets(stores, forEach);
  dealToPartitions(stores, forEach);
  forEach(kPartitions, [&](size_t partition) { sortPartition(partition, stores.size()); });
  std::fill_n(starts_ + buckets, kStartsBeyond, static_cast<uint32_t>(size));
}

template <class S>
size_t PhotonMap<S>::arenaBytes(size_t capacity) {
  // Each array is rounded up to whole lines.
  const size_t starts = (bucketCount(capacity) + kStartsBeyond) * sizeof(uint32_t);
  return capacity * 2 * (sizeof(PhotonKey<S>) + sizeof(uint32_t)) + starts + 5 * kColumnAlignment;
}

template <class S>
size_t PhotonMap<S>::bytesFor(size_t count) {
  return arenaBytes(withRoom(count));
}

template <class S>
size_t PhotonMap<S>::bytes() const {
  return arenaBytes(capacity_);
}

template struct PhotonMap<float>;
template struct PhotonMap<double>;

}  // namespace wavecrest
