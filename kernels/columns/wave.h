// A wave: the columns of a few thousand paths that one worker takes from generation to the film.
#pragma once

#include <type_traits>

#include "kernels/columns/records.h"

namespace wavecrest {

// The front of paths, and what they carry, at their vertices.
template <class S>
struct Vertices {
  Rays<S> rays;
  Hits hits;
  Surfaces<S> surfaces;
  PathStates<S> paths;

  // Drops the columns that are not needed. The others have no memory until they are bound.
  explicit Vertices(const ColumnNeeds& needs) {
    surfaces.keepDetails(needs);
    if (!needs.instances) hits.instance.drop();
    if (!needs.rouletteScale) paths.rouletteScale.drop();
    if (!needs.connections) {
      paths.dVC.drop();
      paths.light.drop();
    }
  }

  template <class Function>
  void forEachQueue(Function&& function) {
    function(rays);
    function(hits);
    function(surfaces);
    function(paths);
  }
};

// Rays behind surfaces that they have passed, and what they meet there.
template <class S>
struct PassingRays {
  Rays<S> rays;
  Hits hits;
  PassageMarks marks;

  template <class Function>
  void forEachQueue(Function&& function) {
    function(rays);
    function(hits);
    function(marks);
  }
};

template <class S>
struct Wave : Vertices<S> {
  using Vertices<S>::rays, Vertices<S>::hits, Vertices<S>::surfaces, Vertices<S>::paths;
  // How many vertices are on opaque diffuse surfaces, which come first; and how many of all may have more than delta
  // lobes, which come before the others.
  size_t diffuse = 0, joinable = 0;
  // The last ones of the pairs, whose light paths may have more vertices to be joined (connectVertices).
  size_t openPairs = 0;
  Vertices<S> aside;  // scratch of arrive (kernels/shade/vertex_order_lanes.h); dropped where all BSDFs are diffuse
  ShadowRays<S> shadowRays;
  Visibility visibility;
  PassingRays<S> passing;          // dropped without passages
  VertexPairs pairs, sortedPairs;  // sortedPairs: dropped where all BSDFs are diffuse
  VertexRows<S> vertexRows;
  VertexCells cells;
  DirectionRecords directions;
  Splats<S> splats;
  Radiance<S> radiance;
  size_t firstPath = 0;  // index of lane 0 in the iteration's order of paths
  size_t pathCount = 0;  // lanes in use when the wave began
  // Camera paths of a wave may be of 2^iterationBits successive iterations: lane i is path firstPath + i >> bits, ahead
  // by the low bits of i. Paths of one pixel then share packets and what they touch of the scene.
  uint32_t iterationBits = 0;

  Wave(size_t capacity, const ColumnNeeds& needs) : Vertices<S>(needs), aside(needs) {
    // The vertices aside have only the columns that PathVertexLanes moves.
    aside.hits.u.drop();
    aside.hits.v.drop();
    aside.hits.instance.drop();
    aside.paths.light.drop();
    // Queues that this scene and method do not use.
    if (!needs.instances) passing.hits.instance.drop();
    if (!needs.passages) {
      passing.forEachQueue([](auto& queue) { queue.drop(); });
      shadowRays.others.drop();
    }
    if (!needs.visibility) visibility.drop();
    if (!needs.connections || !needs.bsdfOrder) sortedPairs.drop();
    if (!needs.bsdfOrder) aside.forEachQueue([](auto& queue) { queue.drop(); });
    if (!needs.splats) splats.drop();
    if (!needs.cells) cells.drop();
    if (!needs.directions) directions.drop();
    if (!needs.connections) {
      pairs.drop();
      vertexRows.row.drop();
    }
    // All columns lie in one block of memory.
    size_t bytes = 0;
    forEachQueue([&](auto& queue) { bytes += queue.bytes(capacity * itemsOfPath(queue)); });
    arena_ = Arena(bytes);
    forEachQueue([&](auto& queue) { queue.bind(arena_, capacity * itemsOfPath(queue)); });
  }

  // The state of another wave of the same capacity and columns, so that a stage can be run on it again.
  void copyFrom(const Wave& other) {
    arena_.copyFrom(other.arena_);
    rays.size = other.rays.size;
    hits.size = other.hits.size;
    surfaces.size = other.surfaces.size;
    paths.size = other.paths.size;
    diffuse = other.diffuse;
    joinable = other.joinable;
    pairs.size = other.pairs.size;
    openPairs = other.openPairs;
    shadowRays.size = other.shadowRays.size;
    vertexRows.size = other.vertexRows.size;
    cells.size = other.cells.size;
    directions.size = other.directions.size;
    splats.size = other.splats.size;
    radiance.size = other.radiance.size;
    firstPath = other.firstPath;
    pathCount = other.pathCount;
    iterationBits = other.iterationBits;
  }

  // Has so many vertices now, others than before.
  void setVertices(size_t count, size_t joinableCount, size_t diffuseCount = 0) {
    rays.size = hits.size = surfaces.size = paths.size = count;
    joinable = joinableCount;
    diffuse = diffuseCount;
    vertexRows.size = 0;
  }

  // Memory of one path in all columns that are needed.
  size_t bytesPerPath() {
    size_t bytes = 0;
    forEachQueue([&](auto& queue) { bytes += queue.bytesPerItem() * itemsOfPath(queue); });
    return bytes;
  }

 private:
  // How many items a path may have in a queue.
  template <class Queue>
  static constexpr size_t itemsOfPath(const Queue&) {
    return std::is_same_v<Queue, DirectionRecords> ? kRecordedDepths : 1;
  }

  // Calls function(queue) for each queue of the wave, always in the same order, on which copyFrom relies.
  template <class Function>
  void forEachQueue(Function&& function) {
    Vertices<S>::forEachQueue(function);
    aside.forEachQueue(function);
    function(shadowRays);
    function(visibility);
    passing.forEachQueue(function);
    function(pairs);
    function(sortedPairs);
    function(vertexRows);
    function(cells);
    function(directions);
    function(splats);
    function(radiance);
  }

  Arena arena_;
};

}  // namespace wavecrest
