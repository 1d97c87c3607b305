// Prefetches what the next stage gathers of a hit, while other rays are traced: in a large scene no cache has it.
#pragma once

#include "kernels/scene_view.h"

namespace wavecrest {

// The record of a primitive.
template <class S>
inline void prefetchPrimitive(const SceneView<S>& scene, uint32_t primitive) {
  const auto* record = reinterpret_cast<const char*>(scene.primitives + primitive);
  for (size_t byte = 0; byte < sizeof(PrimitiveRecord<S>); byte += 64) __builtin_prefetch(record + byte);
}
// What the records of these primitives, or kMiss, point to: best once the records themselves are near.
template <class S>
inline void prefetchAttributes(const SceneView<S>& scene, const uint32_t* primitives, size_t count) {
  for (size_t k = 0; k < count; ++k) {
    if (primitives[k] == kMiss) continue;
    const uint32_t index = scene.primitives[primitives[k]].attributes;
    if (index != kNoIndex) __builtin_prefetch(scene.attributes + index);
  }
}

}  // namespace wavecrest
