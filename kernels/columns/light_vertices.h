// Vertices of light paths, kept for connections and merges.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "kernels/columns/wave.h"

namespace wavecrest {

// How a light vertex is linked to: its index, with kOtherLink where its BSDF is another than opaque diffuse; or
// kNoIndex.
constexpr uint32_t kOtherLink = 1u << 31, kLinkIndex = kOtherLink - 1;

template <class S>
struct LightVertices : Columns<LightVertices<S>>, VertexDetails<S> {
  Column<VertexRow<S>> row;
  Column<uint32_t> cell, place;  // in the grid of photons (kernels/columns/photon_grid.h); dropped without merges
  // Dropped without connections, as the details are.
  Column<uint32_t> lane;  // of the path, in its wave
  Column<uint32_t> next;  // link to the vertex after it that the path has here
  auto all() { return std::tuple_cat(std::tie(row, cell, place, lane, next), this->details()); }
};

// What camera paths do with light vertices.
struct LightVertexUse {
  bool connected = true, merged = true;
};

// The light vertices of one wave, by depth, and within one in the order of the wave's vertices: rows, which connections
// and merges read; for merging also where they are in the grid, because a photon map is built from that alone.
//
// Grows between stages to what a wave needs and keeps that memory, so a steady state allocates nothing.
// Path i of an iteration is lane i % lanes of store i / lanes.
template <class S>
class LightStore {
 public:
  LightVertices<S> vertices;

  LightStore(size_t lanes, const ColumnNeeds& needs, LightVertexUse use = {})
      : lanes_(lanes), firstOfLane_(lanes, kNoIndex), lastOfLane_(lanes, kNoIndex) {
    vertices.keepDetails(needs);
    if (!use.connected) {
      vertices.dropDetails();
      vertices.lane.drop();
      vertices.next.drop();
    }
    if (!use.merged) {
      vertices.cell.drop();
      vertices.place.drop();
    }
  }

  // Whether vertices can be connected, and merged.
  bool keepsLanes() const { return vertices.lane.needed(); }
  bool keepsPlaces() const { return vertices.place.needed(); }

  // Forgets the vertices of the previous wave.
  void clear() {
    vertices.size = 0;
    depths_ = 0;
    roomUsed_ = 0;
    std::fill(firstOfLane_.begin(), firstOfLane_.end(), kNoIndex);
    std::fill(lastOfLane_.begin(), lastOfLane_.end(), kNoIndex);
  }

  // Begins the vertices of the next depth (1, 2, ...), with room for `count` of them.
  void beginDepth(size_t count) {
    ++depths_;
    if (firstOfDepth_.size() <= depths_) {
      firstOfDepth_.resize(depths_ + 8);
      endOfDiffuse_.resize(depths_ + 8);
    }
    firstOfDepth_[depths_] = endOfDiffuse_[depths_] = vertices.size;
    const size_t needed = vertices.size + count;
    roomUsed_ = std::max(roomUsed_, needed);
    if (needed > vertices.capacity()) grow(std::max(needed, vertices.capacity() + vertices.capacity() / 4));
  }

  // Room for so many vertices, as a plan of memory foresees them.
  void reserve(size_t capacity) {
    if (capacity > vertices.capacity()) grow(capacity);
  }
  // The same in memory that outlives the store, of which it takes arenaBytes(capacity): merging reads photons in no
  // order, and many stores side by side lie on large pages. A store that outgrows this gets memory of its own.
  void reserve(size_t capacity, Arena& shared) {
    if (capacity <= vertices.capacity()) return;
    moveTo(shared, capacity);
    sharedBytes_ += arenaBytes(capacity);
  }
  size_t arenaBytes(size_t capacity) const { return vertices.bytes(capacity); }

  // Becomes the vertices of paths first, first + 1, ... of an iteration, `used` of them, counted around after the last
  // of its lightPaths: what camera paths are joined with where there are not as many of them.
  template <class Stores>
  void collect(const Stores& stores, size_t lightPaths, size_t first, size_t used) {
    clear();
    bool deeper = true;
    for (uint32_t depth = 1; deeper; ++depth) {
      deeper = false;
      beginDepth(used);
      for (size_t lane = 0; lane < used;) {
        // The paths up to the end of a store, or of the iteration.
        const size_t path = (first + lane) % lightPaths;
        const size_t count = std::min({used - lane, lightPaths - path, lanes_ - path % lanes_});
        deeper |= copyLanes(*stores[path / lanes_], depth, path % lanes_, count, lane);
        lane += count;
      }
    }
  }

  uint32_t depths() const { return static_cast<uint32_t>(depths_); }
  // The vertices of a depth (1 .. depths()) are those from firstOf(depth) up to firstOf(depth + 1).
  size_t firstOf(uint32_t depth) const { return depth > depths_ ? vertices.size : firstOfDepth_[depth]; }
  // Link to the first vertex of each lane's path; from there `next` leads to the others.
  const uint32_t* firstOfLane() const { return firstOfLane_.data(); }
  // Links the `count` vertices that the depth got last, whose lanes are known, to their paths; the first `diffuse` of
  // them have opaque diffuse BSDFs.
  void link(size_t count, size_t diffuse) {
    const size_t first = vertices.size - count;
    for (size_t i = first; i < vertices.size; ++i) {
      uint32_t& last = lastOfLane_[vertices.lane[i]];
      uint32_t& from = last == kNoIndex ? firstOfLane_[vertices.lane[i]] : vertices.next[last];
      last = static_cast<uint32_t>(i);
      from = i < first + diffuse ? last : last | kOtherLink;
      vertices.next[i] = kNoIndex;
    }
    endOfDiffuse_[depths_] = first + diffuse;
  }
  size_t lanes() const { return lanes_; }

  // The capacity that the depths begun since clear() have asked for.
  size_t roomUsed() const { return roomUsed_; }

  // Memory of its own, and what it took of others', though it may have outgrown that.
  size_t bytes() const { return sharedBytes_ + ownBytes_ + 2 * lanes_ * sizeof(uint32_t); }
  // The same for a store that has reserved this capacity.
  size_t bytesFor(size_t capacity) const { return arenaBytes(capacity) + 2 * lanes_ * sizeof(uint32_t); }

 private:
  void grow(size_t capacity) {
    Arena arena(arenaBytes(capacity));
    moveTo(arena, capacity);
    arena_ = std::move(arena);
    ownBytes_ = arenaBytes(capacity);
  }
  void moveTo(Arena& arena, size_t capacity) {
    LightVertices<S> larger = vertices;  // the same columns dropped
    const size_t size = vertices.size;
    larger.bind(arena, capacity);
    copyColumns(vertices.all(), larger.all(), 0, 0, size, Indices());
    vertices = larger;
    vertices.size = size;
  }

  // Appends what the lanes [begin, begin + count) of another store have at a depth, as lanes from `target` on; whether
  // any path there is that long.
  bool copyLanes(const LightStore& from, uint32_t depth, size_t begin, size_t count, size_t target) {
    if (depth > from.depths()) return false;
    LightVertices<S> origin = from.vertices;  // pointers only: all() has one form, for writing
    const auto within = [&](size_t i) { return origin.lane[i] - begin < count; };
    const size_t end = from.firstOf(depth + 1);
    for (size_t i = from.firstOf(depth); i < end;) {
      const size_t source = i;
      while (i < end && within(i)) ++i;
      const size_t copied = i - source, at = vertices.claim(copied);
      copyColumns(origin.all(), vertices.all(), source, at, copied, Indices());
      for (size_t k = at; k < at + copied; ++k) {
        vertices.lane[k] = static_cast<uint32_t>(vertices.lane[k] - begin + target);
      }
      link(copied, std::clamp(from.endOfDiffuse_[depth], source, i) - source);
      while (i < end && !within(i)) ++i;
    }
    return true;
  }

  using Tuple = decltype(std::declval<LightVertices<S>&>().all());
  using Indices = std::make_index_sequence<std::tuple_size_v<Tuple>>;
  // Items [source, source + count) of one set of columns to [target, ...) of another, as far as both have them.
  template <size_t... kIndex>
  static void copyColumns(Tuple from, Tuple to, size_t source, size_t target, size_t count,
                          std::index_sequence<kIndex...>) {
    const auto copy = [=](auto& a, auto& b) {
      if (a.needed() && b.needed() && count != 0) std::memcpy(&b[target], &a[source], count * sizeof(a[0]));
    };
    (copy(std::get<kIndex>(from), std::get<kIndex>(to)), ...);
  }

  size_t lanes_;
  size_t depths_ = 0, roomUsed_ = 0;
  size_t sharedBytes_ = 0, ownBytes_ = 0;
  // By depth; of its vertices the diffuse ones come first, but for those collected from several stores.
  std::vector<size_t> firstOfDepth_, endOfDiffuse_;
  std::vector<uint32_t> firstOfLane_, lastOfLane_;
  Arena arena_;
};

}  // namespace wavecrest
