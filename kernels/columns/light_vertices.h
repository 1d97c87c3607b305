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
// Path i of an iteration is lane i % lanes of store i / lanes.
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
    roomUsed_ = 0;
  }

  // Begins the vertices of the next depth (1, 2, ...), with room for `count` of them.
  void beginDepth(size_t count) {
    ++depths_;
    if (partners_.size() < depths_ * lanes_) partners_.resize(depths_ * lanes_);
    std::fill_n(partners_.begin() + static_cast<std::ptrdiff_t>((depths_ - 1) * lanes_), lanes_, kNoIndex);
    const size_t needed = vertices.size + count;
    roomUsed_ = std::max(roomUsed_, needed);
    if (needed > vertices.capacity()) grow(std::max(needed, vertices.capacity() + vertices.capacity() / 4));
  }

  // Room for so many vertices, as a plan of memory foresees them.
  void reserve(size_t capacity) {
    if (capacity > vertices.capacity()) grow(capacity);
  }

  // Becomes the vertices of paths first, first + 1, ... of an iteration, as many as there are lanes in use, counted
  // around after the last of its lightPaths: what camera paths are joined with where there are not as many of them.
  template <class Stores>
  void collect(const Stores& stores, size_t lightPaths, size_t first, size_t used) {
    clear();
    bool deeper = true;
    for (uint32_t depth = 1; deeper; ++depth) {
      deeper = false;
      beginDepth(used);
      for (size_t lane = 0; lane < used; ++lane) {
        const size_t path = (first + lane) % lightPaths;
        const LightStore& from = *stores[path / lanes_];
        if (depth > from.depths()) continue;
        deeper = true;
        const uint32_t source = from.partners(depth)[path % lanes_];
        if (source == kNoIndex) continue;
        const size_t target = vertices.claim(1);
        LightVertices<S> origin = from.vertices;  // pointers only: all() has one form, for writing
        copyColumns(origin.all(), vertices.all(), source, target, 1, Indices());
        partners(depth)[lane] = static_cast<uint32_t>(target);
      }
    }
  }

  uint32_t depths() const { return static_cast<uint32_t>(depths_); }
  // Index of each lane's vertex at this depth (1 .. depths()), or kNoIndex.
  const uint32_t* partners(uint32_t depth) const { return partners_.data() + (depth - 1) * lanes_; }
  uint32_t* partners(uint32_t depth) { return partners_.data() + (depth - 1) * lanes_; }

  // The capacity that the depths begun since clear() have asked for.
  size_t roomUsed() const { return roomUsed_; }

  size_t bytes() const { return vertices.bytes(vertices.capacity()) + partners_.size() * sizeof(uint32_t); }
  // The same for a store of this capacity whose longest path has so many vertices.
  size_t bytesFor(size_t capacity, size_t depths) const {
    return vertices.bytes(capacity) + depths * lanes_ * sizeof(uint32_t);
  }

 private:
  void grow(size_t capacity) {
    LightVertices<S> larger = vertices;  // the same columns dropped
    Arena arena(larger.bytes(capacity));
    const size_t size = vertices.size;
    larger.bind(arena, capacity);
    copyColumns(vertices.all(), larger.all(), 0, 0, size, Indices());
    vertices = larger;
    vertices.size = size;
    arena_ = std::move(arena);
  }

  using Tuple = decltype(std::declval<LightVertices<S>&>().all());
  using Indices = std::make_index_sequence<std::tuple_size_v<Tuple>>;
  // Items [source, source + count) of one set of columns to [target, ...) of another.
  template <size_t... kIndex>
  static void copyColumns(Tuple from, Tuple to, size_t source, size_t target, size_t count,
                          std::index_sequence<kIndex...>) {
    const auto copy = [=](auto& a, auto& b) {
      if (a.needed() && count != 0) std::memcpy(&b[target], &a[source], count * sizeof(a[0]));
    };
    (copy(std::get<kIndex>(from), std::get<kIndex>(to)), ...);
  }

  size_t lanes_;
  size_t depths_ = 0, roomUsed_ = 0;
  std::vector<uint32_t> partners_;
  Arena arena_;
};

}  // namespace wavecrest
