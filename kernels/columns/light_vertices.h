// Vertices of light paths, kept for connections and merges.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "kernels/columns/wave.h"

namespace wavecrest {

template <class S>
struct LightVertices : Columns<LightVertices<S>> {
  Column<S> positionX, positionY, positionZ;
  Column<S> fixX, fixY, fixZ;  // unit direction back along the light path
  Column<S> normalX, normalY, normalZ;
  Column<S> shadingX, shadingY, shadingZ;  // dropped where the scene has no shading normals
  Column<S> offset;
  Column<S> throughputR, throughputG, throughputB;
  Column<S> dVCM, dVC, dVM;
  Column<float> uvU, uvV;  // dropped where the scene has no textures
  Column<uint32_t> primitive;
  Column<uint32_t> depth;  // edges from the light
  auto all() {
    return std::tie(positionX, positionY, positionZ, fixX, fixY, fixZ, normalX, normalY, normalZ, shadingX, shadingY,
                    shadingZ, offset, throughputR, throughputG, throughputB, dVCM, dVC, dVM, uvU, uvV, primitive,
                    depth);
  }
};

// The light vertices of one wave, in the order (depth, lane), and where each lane's are.
//
// Grows between stages to what a wave needs and keeps that memory, so a steady state allocates nothing.
template <class S>
class LightStore {
 public:
  LightVertices<S> vertices;

  LightStore(size_t lanes, const ColumnNeeds& needs) : lanes_(lanes) {
    if (!needs.shadingNormals) {
      for (Column<S>* column : {&vertices.shadingX, &vertices.shadingY, &vertices.shadingZ}) column->drop();
    }
    if (!needs.textures) {
      vertices.uvU.drop();
      vertices.uvV.drop();
    }
  }

  // Forgets the vertices of the previous wave.
  void clear() {
    vertices.size = 0;
    depths_ = 0;
  }

  // Begins the vertices of the next depth (1, 2, ...), with room for `count` of them.
  void beginDepth(size_t count) {
    ++depths_;
    if (partners_.size() < depths_ * lanes_) partners_.resize(depths_ * lanes_);
    std::fill_n(partners_.begin() + static_cast<std::ptrdiff_t>((depths_ - 1) * lanes_), lanes_, kNoIndex);
    if (vertices.size + count > vertices.capacity()) grow(std::max(vertices.size + count, 2 * vertices.capacity()));
  }

  uint32_t depths() const { return static_cast<uint32_t>(depths_); }
  // Index of each lane's vertex at this depth (1 .. depths()), or kNoIndex.
  const uint32_t* partners(uint32_t depth) const { return partners_.data() + (depth - 1) * lanes_; }
  uint32_t* partners(uint32_t depth) { return partners_.data() + (depth - 1) * lanes_; }

  size_t bytes() const { return vertices.bytes(vertices.capacity()) + partners_.size() * sizeof(uint32_t); }

 private:
  void grow(size_t capacity) {
    LightVertices<S> larger = vertices;  // the same columns dropped
    Arena arena(larger.bytes(capacity));
    const size_t size = vertices.size;
    larger.bind(arena, capacity);
    copyColumns(vertices.all(), larger.all(), size, std::make_index_sequence<std::tuple_size_v<Tuple>>());
    vertices = larger;
    vertices.size = size;
    arena_ = std::move(arena);
  }

  using Tuple = decltype(std::declval<LightVertices<S>&>().all());
  template <size_t... kIndex>
  static void copyColumns(Tuple from, Tuple to, size_t size, std::index_sequence<kIndex...>) {
    const auto copy = [size](auto& source, auto& target) {
      if (source.needed() && size != 0) std::memcpy(&target[0], &source[0], size * sizeof(source[0]));
    };
    (copy(std::get<kIndex>(from), std::get<kIndex>(to)), ...);
  }

  size_t lanes_;
  size_t depths_ = 0;
  std::vector<uint32_t> partners_;
  Arena arena_;
};

}  // namespace wavecrest
