// Another intersector of large scenes, beside bvh.h: Embree 3 (or 4, chosen by the headers that are installed) behind
// the interface of a stage.
//
// Geometries: quads, triangles and spheres, in that order, so Embree's (geometry, primitive) pair maps to an index into
// SceneView::primitives by one addition. Rays go in packets; Embree's stream interface is not used (gone in Embree 4).
#pragma once

#include <atomic>
#include <cstdint>

#include "kernels/stages.h"

namespace wavecrest {

// Rays per call of the renderer; bench/micro compares the widths.
constexpr size_t kEmbreePacket = 16;

class EmbreeScene {
 public:
  // records: quads, then triangles, then spheres. The hierarchy is built at once, by as many threads as the calling TBB
  // arena has. Throws std::runtime_error with Embree's message if that fails.
  template <class S>
  EmbreeScene(const PrimitiveRecord<S>* records, uint32_t quads, uint32_t triangles, uint32_t spheres,
              bool watertight = true);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  void* handle() const { return scene_; }  // RTCScene
  // Memory of the geometry and its hierarchy, as Embree counts it.
  size_t bytes() const { return static_cast<size_t>(bytes_.load()); }

 private:
  std::atomic<int64_t> bytes_{0};
  void* device_ = nullptr;  // RTCDevice
  void* scene_ = nullptr;
};

// extend and occlude, with the contracts of extend_small.cpp and occlude_small.cpp. kWidth: 4, 8 or 16 rays per call.
template <class S, size_t kWidth = kEmbreePacket>
void extendEmbree(const StageContext<S>& context, Wave<S>& wave);
template <class S, size_t kWidth = kEmbreePacket>
void occludeEmbree(const StageContext<S>& context, Wave<S>& wave);

}  // namespace wavecrest
