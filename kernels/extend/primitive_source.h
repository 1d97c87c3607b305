// What intersectors are built from: the scene's primitives in double, each made when it is asked for.
//
// In double, so that faces which share a corner agree on its float. A scene of ten million triangles would need 1.3 GB
// to have them all at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "kernels/scene_view.h"

namespace wavecrest {

// Runs body(i) for each i in [0, count), in any order and perhaps on several threads; returns when all are done. Bodies
// may call it again. Kernels have no threads of their own: whoever builds an intersector brings them.
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

struct PrimitiveRange {
  size_t first = 0, count = 0;
};

// All primitives of a scene, or those of a part of it.
struct PrimitiveSource {
  PrimitiveRange quads, triangles, spheres;                   // of indices into SceneView::primitives
  std::function<PrimitiveRecord<double>(size_t index)> at{};  // from any thread

  size_t count() const { return quads.count + triangles.count + spheres.count; }
  // Of records in SceneView order, which must outlive the source.
  static PrimitiveSource of(const PrimitiveRecord<double>* records, size_t count) {
    PrimitiveSource source;
    for (size_t i = 0; i < count; ++i) {
      switch (static_cast<PrimitiveKind>(records[i].kind)) {
        case PrimitiveKind::quad:
          ++source.quads.count;
          break;
        case PrimitiveKind::triangle:
          ++source.triangles.count;
          break;
        case PrimitiveKind::sphere:
          ++source.spheres.count;
          break;
      }
    }
    source.triangles.first = source.quads.count;
    source.spheres.first = source.quads.count + source.triangles.count;
    source.at = [records](size_t i) { return records[i]; };
    return source;
  }
};

}  // namespace wavecrest
