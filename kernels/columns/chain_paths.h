// Paths of Metropolis light transport in path space: the vertices themselves, one chain to a lane.
//
// A path x_0 (light) .. x_k (lens) is k + 1 rows of vertices; row i of all chains of a wave lies together, lane by
// lane. The current paths belong to the chains, the proposed ones to the worker that traces them.
#pragma once

#include <cstdint>

#include "kernels/columns/wave.h"

namespace wavecrest {

// How a path goes on at a vertex. Anything but `scattered` is a delta lobe, and no joint of walks.
enum class PathEvent : uint32_t { scattered, reflected, refracted, passed };

// Kinds of mutation, of all variants. large and small are those of primary samples; in path space a large step deletes
// the whole path.
enum class Mutation : uint32_t { large, small, bidirectional, lens, multiChain, caustic };
constexpr size_t kMutationKinds = 6;

// (K + 1) rows of vertices. Index of row i, lane j: i * stride + j.
//
// The densities belong to METHODS 7.6: eye[i] and light[i] are those of x_i per area, made from the eye's side and from
// the light's; eyeChoice and lightChoice those of the direction that leaves x_i, per solid angle or, of a delta lobe,
// its probability, whatever that of the normal that a light walk draws. step is f c / pdf of an eye walk at x_i; at x_1
// its end is the light: f c L n_0 / (d^2 light[0]).
template <class S>
struct PathVertices : Columns<PathVertices<S>>, VertexDetails<S> {
  Column<S> positionX, positionY, positionZ;  // of x_0 at infinity: the direction towards it
  Column<S> normalX, normalY, normalZ;        // geometric
  Column<S> offset;
  Column<uint32_t> primitive;  // of x_0: the light
  Column<uint32_t> event;      // PathEvent
  Column<S> stepR, stepG, stepB;
  Column<S> eye, light, eyeChoice, lightChoice;
  auto all() {
    return std::tuple_cat(std::tie(positionX, positionY, positionZ, normalX, normalY, normalZ, offset, primitive, event,
                                   stepR, stepG, stepB, eye, light, eyeChoice, lightChoice),
                          this->details());
  }
};

// What belongs to a path as a whole.
template <class S>
struct PathHeaders : Columns<PathHeaders<S>> {
  Column<uint32_t> edges;            // k; 0: no path yet
  Column<float> rasterX, rasterY;    // where x_{k-1} is seen
  Column<S> lightR, lightG, lightB;  // radiance of x_0, of a spot or projector without its beamFactor
  // Which perturbations suit: see kernels/mutate/path_pattern.h.
  Column<uint32_t> eyeEnd, multiChain, causticStart;
  auto all() { return std::tie(edges, rasterX, rasterY, lightR, lightG, lightB, eyeEnd, multiChain, causticStart); }
};

template <class S>
struct PathStore {
  PathVertices<S> vertices;
  PathHeaders<S> headers;

  PathStore(size_t lanes, uint32_t maxEdges, const ColumnNeeds& needs) : stride_(paddedItems(lanes)) {
    vertices.keepDetails(needs);
    arena_ = Arena(bytesFor(lanes, maxEdges, needs));
    vertices.bind(arena_, (maxEdges + 1) * stride_);
    headers.bind(arena_, lanes);
  }
  size_t stride() const { return stride_; }

  static size_t bytesFor(size_t lanes, uint32_t maxEdges, const ColumnNeeds& needs) {
    PathVertices<S> shape;
    shape.keepDetails(needs);
    return shape.bytes((maxEdges + 1) * paddedItems(lanes)) + PathHeaders<S>().bytes(lanes);
  }

 private:
  size_t stride_;
  Arena arena_;
};

// What a proposal does to the current path: rows below `lightKept` stay, rows from `eyeFrom` on stay and become those
// from `eyeTo` on, and what lies between is replaced by `lightWalked` vertices made from the light's side and the rest
// made from the eye's. Written by proposePaths, but for the last row.
struct PathPlans : Columns<PathPlans> {
  Column<uint32_t> kind;  // Mutation
  Column<uint32_t> lightKept, eyeFrom, eyeTo, lightWalked;
  Column<uint32_t> lightRays, eyeRays;                              // how many edges the walks trace
  Column<uint32_t> order;                                           // lanes by kind: the order of the walks
  Column<uint32_t> lightReached, eyeReached, lightEvent, eyeEvent;  // edges traced; events of the rows where they begin
  Column<float> angle;                                              // of a caustic perturbation
  auto all() {
    return std::tie(kind, lightKept, eyeFrom, eyeTo, lightWalked, lightRays, eyeRays, order, lightReached, eyeReached,
                    lightEvent, eyeEvent, angle);
  }
};

struct PathLaw;  // kernels/mutate/path_law.h

// What the stages of path space work on: the context's `paths`.
template <class S>
struct PathMutations {
  PathStore<S> proposed;
  PathPlans plans;
  Column<uint32_t> lanes;  // scratch: lanes whose proposals are whole
  size_t laneCount = 0;
  PathStore<S>* current = nullptr;  // none: all proposals are large and none is kept
  const PathLaw* law = nullptr;

  PathMutations(size_t capacity, uint32_t maxEdges, const ColumnNeeds& needs) : proposed(capacity, maxEdges, needs) {
    arena_ = Arena(plans.bytes(capacity) + lanes.bytes(capacity));
    plans.bind(arena_, capacity);
    lanes.bind(arena_, capacity);
  }
  static size_t bytesFor(size_t capacity, uint32_t maxEdges, const ColumnNeeds& needs) {
    return PathStore<S>::bytesFor(capacity, maxEdges, needs) + PathPlans().bytes(capacity) +
           Column<uint32_t>().bytes(capacity);
  }

 private:
  Arena arena_;
};

}  // namespace wavecrest
