// Stored light vertices in lanes, packed: of a run of the store's vertices those that a stage wants, in order.
//
// Copying every column past the ones that are not wanted costs less than gathering them one by one later.
#pragma once

#include <cstring>

#include "kernels/columns/light_vertices.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/shading_lanes.h"

WAVECREST_SIMD_BEGIN

template <class P, uint32_t kFeatures>
class PackedLightVertices {
  using Real = typename P::Real;
  using S = typename P::Storage;

 public:
  // Pushing is allowed while there is room for a whole block.
  static constexpr size_t kCapacity = 8 * kLanes;
  size_t size() const { return size_; }
  bool hasRoom() const { return size_ + kLanes <= kCapacity; }

  // The lanes of block i in m, and the camera vertex that each is to be joined with.
  WAVECREST_INLINE void push(const LightVertices<S>& v, size_t i, Mask m, UInt camera) {
    const auto pack = [&](const auto& column, auto* to) WAVECREST_LAMBDA {
      storeUnaligned(compress(loadUnaligned(static_cast<decltype(to)>(column) + i), m), to + size_);
    };
    const auto packVec3 = [&](const Column<S>& x, const Column<S>& y, const Column<S>& z, S(&to)[3][kItems])
                              WAVECREST_LAMBDA {
                                pack(x, to[0]);
                                pack(y, to[1]);
                                pack(z, to[2]);
                              };
    packVec3(v.positionX, v.positionY, v.positionZ, position_);
    packVec3(v.fixX, v.fixY, v.fixZ, fix_);
    packVec3(v.normalX, v.normalY, v.normalZ, normal_);
    packVec3(v.throughputR, v.throughputG, v.throughputB, throughput_);
    if constexpr (has(kFeatures, kShadingNormals)) packVec3(v.shadingX, v.shadingY, v.shadingZ, shadingNormal_);
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (v.baseX.needed()) packVec3(v.baseX, v.baseY, v.baseZ, baseNormal_);
    }
    if constexpr (has(kFeatures, kTextures)) {
      pack(v.uvU, uv_[0]);
      pack(v.uvV, uv_[1]);
    }
    pack(v.offset, offset_);
    pack(v.dVCM, dVCM_);
    pack(v.dVC, dVC_);
    pack(v.primitive, primitive_);
    pack(v.lane, lane_);
    storeUnaligned(compress(camera, m), camera_ + size_);
    size_ += countTrue(m);
  }

  // Forgets all.
  void clear() { size_ = 0; }

  // Of a whole block: lanes past the last have vertex 0, once the list is closed.
  const uint32_t* camera(size_t i) const { return camera_ + i; }
  void close() { storeUnaligned(UInt(0u), camera_ + size_); }
  UInt lane(size_t i) const { return load(lane_ + i); }
  Vec3<Real> throughput(size_t i) const { return vec3(throughput_, i); }
  MisSums<Real> mis(size_t i) const { return {load(dVCM_ + i), load(dVC_ + i), Real(0)}; }

  WAVECREST_INLINE ShadingLanes<P, kFeatures> shading(const SceneView<S>& scene, size_t i, Mask active) const {
    VertexLanes<Real> vertex{.position = vec3(position_, i),
                             .fix = vec3(fix_, i),
                             .normal = vec3(normal_, i),
                             .shadingNormal = vec3(normal_, i),
                             .baseNormal = vec3(normal_, i),
                             .offset = load(offset_ + i),
                             .u = Float(0),
                             .v = Float(0),
                             .material = materialOf(scene, select(active, load(primitive_ + i), UInt(0u)))};
    if constexpr (has(kFeatures, kShadingNormals)) vertex.shadingNormal = vec3(shadingNormal_, i);
    if constexpr (has(kFeatures, kNormalMaps)) {
      if (scene.normalMaps) vertex.baseNormal = vec3(baseNormal_, i);
    }
    if constexpr (has(kFeatures, kTextures)) {
      vertex.u = load(uv_[0] + i);
      vertex.v = load(uv_[1] + i);
    }
    auto shading = shadingOf<P, kFeatures>(scene, vertex);
    shading.bsdf.walk = Walk::light;
    return shading;
  }

 private:
  static constexpr size_t kItems = kCapacity + kLanes;  // stores of whole blocks may begin at the last item

  WAVECREST_INLINE static Vec3<Real> vec3(const S (&columns)[3][kItems], size_t i) {
    return {load(columns[0] + i), load(columns[1] + i), load(columns[2] + i)};
  }

  HWY_ALIGN S position_[3][kItems], fix_[3][kItems], normal_[3][kItems], throughput_[3][kItems];
  HWY_ALIGN S shadingNormal_[3][kItems], baseNormal_[3][kItems];
  HWY_ALIGN S offset_[kItems], dVCM_[kItems], dVC_[kItems];
  HWY_ALIGN float uv_[2][kItems];
  HWY_ALIGN uint32_t primitive_[kItems], lane_[kItems], camera_[kItems];
  size_t size_ = 0;
};

WAVECREST_SIMD_END
