// The order of a wave's vertices: first those on opaque diffuse surfaces, then those with other lobes that joins can
// use, at last those of delta lobes alone; among themselves in the order of their rays. Blocks of one BSDF skip the
// others, and stages that join vertices leave the last ones out.
//
// Lanes of the first kind are moved to the front of the columns they came from. The others go to the wave's columns
// aside, from their end towards their beginning, and are put behind the first when all of these are known: each block
// costs one permutation and two stores for a column, whatever its lanes are.
#pragma once

#include "kernels/shade/path_vertex_lanes.h"
#include "kernels/shade/shading_lanes.h"

WAVECREST_SIMD_BEGIN

// Fills a wave with vertices in order, while the rays that they were found along are still being read from it: what is
// written lies before what is read next.
template <class P, uint32_t kFeatures>
class VertexOrder {
  using Real = typename P::Real;
  using S = typename P::Storage;
  using Vertex = PathVertexLanes<kFeatures, Real>;

 public:
  VertexOrder(const SceneView<S>& scene, Wave<S>& wave) : scene_(scene), wave_(wave) {}

  // The lanes of m of a block. material: of each lane.
  WAVECREST_INLINE void append(Vertex vertex, Mask m, UInt material) {
    if constexpr (onlyDiffuse(kFeatures)) {
      vertex.forEach(wave_, [&](auto& number, auto& column)
                                WAVECREST_LAMBDA { WAVECREST_SIMD_NAMESPACE::append(number, m, column, size_); });
      size_ += countTrue(m);
    } else {
      const MaterialLanes at(scene_, material);
      Mask diffuse = m & (at(scene_.materials->kind) == UInt(static_cast<uint32_t>(BsdfKind::diffuse)));
      if constexpr (has(kFeatures, kLayeredBsdfs)) {  // which have opacity as well
        diffuse = andNot(diffuse, (at(scene_.materials->flags) & UInt(kHasDelta)) == UInt(kHasDelta));
      }
      put(vertex, diffuse, andNot(m, diffuse), splitOrder(diffuse, andNot(m, diffuse)));
    }
  }

  // Puts the others behind the diffuse ones.
  WAVECREST_INLINE void finish() {
    const size_t diffuse = size_;
    size_t joinable = size_;
    if constexpr (!onlyDiffuse(kFeatures)) {
      const UInt backwards = UInt(static_cast<uint32_t>(kLanes - 1)) - laneIndex();
      const size_t others = aside_;
      aside_ = 0;
      Vertex vertex;
      for (size_t i = 0; i < others; i += kLanes) {
        read(vertex, i);
        const UInt primitive = select(firstLanes(others - i), inOrder(vertex.primitive, backwards), UInt(0u));
        const UInt kind = MaterialLanes(scene_, materialOf(scene_, primitive))(scene_.materials->kind);
        const Mask finite = firstLanes(others - i) & hasNonDeltaLobes(kind);
        const Mask delta = andNot(firstLanes(others - i), finite);
        put(vertex, finite, delta, UInt(static_cast<uint32_t>(kLanes - 1)) - splitOrder(finite, delta));
      }
      joinable = size_;
      for (size_t i = 0; i < aside_; i += kLanes) {
        read(vertex, i);
        vertex.forEach(wave_, [&](auto& number, auto& column)
                                  WAVECREST_LAMBDA { storeUnaligned(inOrder(number, backwards), column + size_ + i); });
      }
      size_ += aside_;
    }
    wave_.setVertices(size_, joinable, diffuse);
  }

 private:
  // Lanes in this order: those that stay come first, and the last ones, last one first, go aside.
  WAVECREST_INLINE void put(Vertex& vertex, Mask stay, Mask goAside, UInt order) {
    vertex.forEach(wave_, [&](auto& number, auto& column) WAVECREST_LAMBDA {
      number = inOrder(number, order);
      storeUnaligned(number, column + size_);
    });
    vertex.forEach(wave_.aside, [&](auto& number, auto& column)
                                    WAVECREST_LAMBDA { storeUnaligned(number, column + end_ - aside_ - kLanes); });
    size_ += countTrue(stay);
    aside_ += countTrue(goAside);
  }
  // The vertices [i, i + kLanes) of those aside, last one first.
  WAVECREST_INLINE void read(Vertex& vertex, size_t i) const {
    vertex.forEach(wave_.aside,
                   [&](auto& number, auto& column) WAVECREST_LAMBDA { number = load(column, end_ - i - kLanes); });
  }

  const SceneView<S>& scene_;
  Wave<S>& wave_;
  size_t size_ = 0, aside_ = 0;
  const size_t end_ = paddedItems(wave_.rays.capacity());
};

WAVECREST_SIMD_END
