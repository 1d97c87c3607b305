#include "kernels/merge/photon_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

namespace wavecrest {
namespace {

// Photons are first dealt to this many partitions by the top bits of the bucket, then sorted within each: the first
// pass writes as many streams, whose pages are all at hand, the second stays within a core's caches for up to some
// million photons.
constexpr uint32_t kPartitions = 64;
// What a cache line holds. Lines are prefetched before they are written: the next ones of each stream while those
// before them are filled, and what a partition is sorted into at once.
constexpr uint32_t kKeysPerLine = kColumnAlignment / sizeof(PhotonKey);
constexpr uint32_t kNumbersPerLine = kColumnAlignment / sizeof(uint32_t);
constexpr uint32_t kMinBuckets = 1u << 12;
constexpr size_t kMostPhotons = size_t{1} << 31;  // buckets are as many or more, and numbered in 32 bits
// Entries of bucketStart after the last bucket's: searches read four from the bucket on.
constexpr size_t kStartsBeyond = 4;

// Iterations differ a little in how many photons they have: some room, so that memory is allocated once.
constexpr size_t withRoom(size_t count) { return count + count / 16; }

// About every second bucket is filled: searches of a hashed grid read what else is in their buckets, but with more of
// them the table outgrows the caches.
constexpr size_t bucketCount(size_t photons) { return std::max<size_t>(std::bit_ceil(photons), kMinBuckets); }

// Stores are counted and dealt by up to this many tasks: a task for each store would be shorter than it takes to hand
// it out.
constexpr size_t kMostStoreTasks = 128;
constexpr size_t storeTasks(size_t stores) { return std::clamp<size_t>(stores, 1, kMostStoreTasks); }
struct Range {
  size_t first, end;
};
constexpr Range storesOf(size_t task, size_t stores) {
  const size_t tasks = storeTasks(stores);
  return {task * stores / tasks, (task + 1) * stores / tasks};
}

}  // namespace

template <class S>
void PhotonMap<S>::countPartitions(size_t task) {
  const int partitionShift = std::countr_zero((bucketMask + 1) / kPartitions);
  const Range stores = storesOf(task, stores_.size());
  for (size_t i = stores.first; i < stores.end; ++i) {
    const LightVertices<S>& v = stores_[i]->vertices;
    std::array<uint32_t, kPartitions> counts{};
    for (size_t k = 0; k < v.size; ++k) ++counts[(v.cell[k] & bucketMask) >> partitionShift];
    for (uint32_t p = 0; p < kPartitions; ++p) offsets_[p * stores_.size() + i + 1] = counts[p];
  }
}

template <class S>
void PhotonMap<S>::addUpCounts(size_t) {
  for (size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
}

// Store by store into its own part of each partition, so the order is the same whoever does it.
template <class S>
void PhotonMap<S>::dealToPartitions(size_t task) {
  const int partitionShift = std::countr_zero((bucketMask + 1) / kPartitions);
  const Range stores = storesOf(task, stores_.size());
  for (size_t i = stores.first; i < stores.end; ++i) {
    const LightVertices<S>& v = stores_[i]->vertices;
    const uint32_t firstPhoton = static_cast<uint32_t>(i) << storeShift;
    std::array<uint32_t, kPartitions> next;
    for (uint32_t p = 0; p < kPartitions; ++p) next[p] = offsets_[p * stores_.size() + i];
    for (uint32_t k = 0; k < v.size; ++k) {
      const uint32_t bucket = v.cell[k] & bucketMask;
      const uint32_t at = next[bucket >> partitionShift]++;
      __builtin_prefetch(dealt_ + at + kKeysPerLine, 1);
      __builtin_prefetch(dealtBuckets_ + at + kNumbersPerLine, 1);
      dealt_[at] = {v.place[k], firstPhoton + k};
      dealtBuckets_[at] = bucket;
    }
  }
}

// A stable counting sort by bucket.
template <class S>
void PhotonMap<S>::sortPartition(size_t partition) {
  const size_t storeCount = stores_.size();
  const uint32_t perPartition = (bucketMask + 1) / kPartitions;
  const uint32_t first = offsets_[partition * storeCount], end = offsets_[(partition + 1) * storeCount];
  uint32_t* const start = starts_ + partition * perPartition;
  const uint32_t* const bucket = dealtBuckets_ + first;
  const uint32_t firstBucket = static_cast<uint32_t>(partition) * perPartition, count = end - first;
  // Counts, then a running sum that leaves in start[b] where bucket b ends. Dealing from the last photon to the first
  // moves each end down to where its bucket begins, and keeps the order within it.
  for (uint32_t b = 0; b < perPartition; b += kNumbersPerLine) __builtin_prefetch(start + b, 1);
  for (uint32_t k = first; k < end; k += kKeysPerLine) {
    __builtin_prefetch(keys_ + k, 1);
    __builtin_prefetch(dealt_ + k);
  }
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
  keys_ = arena_.take<PhotonKey>(capacity_);
  dealt_ = arena_.take<PhotonKey>(capacity_);
  dealtBuckets_ = arena_.take<uint32_t>(capacity_);
  starts_ = arena_.take<uint32_t>(bucketCount(capacity_) + kStartsBeyond);
  keys = keys_;
  bucketStart = starts_;
}

template <class S>
void PhotonMap<S>::prepare(std::span<LightStore<S>* const> stores, const PhotonGrid<S>& over) {
  grid = over;
  stores_.assign(stores.begin(), stores.end());
  rows.clear();
  size = 0;
  size_t largest = 1;
  for (const LightStore<S>* store : stores) {
    size += store->vertices.size;
    rows.push_back(store->vertices.row);
    largest = std::max(largest, store->vertices.size);
  }
  storeShift = static_cast<uint32_t>(std::bit_width(largest - 1));
  if (size > kMostPhotons || stores.size() > (size_t{1} << (32 - storeShift))) {
    throw std::length_error("PhotonMap: more light vertices than 32 bits can tell apart");
  }
  reserve(std::max<size_t>(size, 1));
  const size_t buckets = bucketCount(size);
  bucketMask = static_cast<uint32_t>(buckets) - 1;
  offsets_.assign(kPartitions * stores.size() + 1, 0);
  std::fill_n(starts_ + buckets, kStartsBeyond, static_cast<uint32_t>(size));
}

template <class S>
std::vector<typename PhotonMap<S>::BuildStep> PhotonMap<S>::buildSteps(size_t stores) {
  return {{storeTasks(stores), &PhotonMap::countPartitions},
          {1, &PhotonMap::addUpCounts},
          {storeTasks(stores), &PhotonMap::dealToPartitions},
          {kPartitions, &PhotonMap::sortPartition}};
}

template <class S>
void PhotonMap<S>::build(std::span<LightStore<S>* const> stores, const PhotonGrid<S>& over, const ForEach& forEach) {
  prepare(stores, over);
  for (const BuildStep& step : buildSteps(stores.size())) {
    forEach(step.tasks, [&](size_t task) { (this->*step.run)(task); });
  }
}

template <class S>
size_t PhotonMap<S>::arenaBytes(size_t capacity) {
  // Each array is rounded up to whole lines.
  const size_t starts = (bucketCount(capacity) + kStartsBeyond) * sizeof(uint32_t);
  return capacity * (2 * sizeof(PhotonKey) + sizeof(uint32_t)) + starts + 4 * kColumnAlignment;
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
