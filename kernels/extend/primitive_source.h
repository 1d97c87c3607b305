// What intersectors are built from: the scene's primitives in double, each made when it is asked for.
//
// In double, so that faces which share a corner agree on its float. A scene of ten million triangles would need 1.3 GB
// to have them all at once.
#pragma once

#include <cstddef>
#include <functional>

#include "kernels/columns/parallel_ranges.h"
#include "kernels/scene_view.h"

namespace wavecrest {

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
