// Work over many elements for whoever brings threads: kernels have none of their own.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>

namespace wavecrest {

// Runs body(i) for each i in [0, count), in any order and perhaps on several threads; returns when all are done. Bodies
// may call it again.
using ParallelFor = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

inline void inTurn(size_t count, const std::function<void(size_t)>& body) {
  for (size_t i = 0; i < count; ++i) body(i);
}

// body(begin, end) over [0, count), in ranges whose places depend on `count` alone: rangesOf(count) of them, and the
// one that starts at `begin` is number rangesOf(begin).
constexpr size_t kRange = size_t{1} << 14;
constexpr size_t rangesOf(size_t count) { return (count + kRange - 1) / kRange; }
template <class Body>
void forEachRange(const ParallelFor& parallelFor, size_t count, const Body& body) {
  if (count <= kRange) {
    if (count > 0) body(size_t{0}, count);
    return;
  }
  parallelFor(rangesOf(count), [&](size_t i) { body(i * kRange, std::min(count, (i + 1) * kRange)); });
}

// Whether holds(i) is true for some i in [0, count). Not all of them are asked once one is found.
template <class Predicate>
bool anyIndex(const ParallelFor& parallelFor, size_t count, const Predicate& holds) {
  std::atomic<bool> found{false};
  forEachRange(parallelFor, count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && !found; ++i) {
      if (holds(i)) found = true;
    }
  });
  return found;
}

}  // namespace wavecrest
