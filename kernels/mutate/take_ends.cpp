// admitWalks, takeEnds: walks of multiplexed chains go exactly as far as their strategy says.
//
// admitWalks: in: Rays, PathStates [n] before the first edge. out: the same [<= n], without walks that have no edge.
// takeEnds: in: Rays (at vertices), Hits, Surfaces, PathStates [n] at a depth. out: the same [<= n] in that order,
// without walks that end here; those have moved to the context's WalkEnds, unless emission was all they were after.
//
// Ends of all depths are gathered, so the stages that join them run once on full blocks of lanes instead of once per
// depth on a few lanes each, and need not know that the walks of a wave have different lengths.
#include <algorithm>

#include "kernels/columns/chains.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/path_vertex_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

template <uint32_t kFeatures, class S>
WAVECREST_INLINE void copyRays(const Wave<S>& from, size_t i, Mask m, Wave<S>& to, size_t out) {
  appendVec3(loadVec3(from.rays.originX, from.rays.originY, from.rays.originZ, i), m, to.rays.originX, to.rays.originY,
             to.rays.originZ, out);
  appendVec3(loadVec3(from.rays.directionX, from.rays.directionY, from.rays.directionZ, i), m, to.rays.directionX,
             to.rays.directionY, to.rays.directionZ, out);
  const PathStates<S>& paths = from.paths;
  appendVec3(loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i), m, to.paths.throughputR,
             to.paths.throughputG, to.paths.throughputB, out);
  appendMis<kFeatures>(loadMis<kFeatures>(paths, i), m, to.paths, out);
  append(load(paths.rouletteScale, i), m, to.paths.rouletteScale, out);
  append(load(paths.lane, i), m, to.paths.lane, out);
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE void copyVertices(const Wave<typename P::Storage>& from, size_t i, Mask m,
                                   Wave<typename P::Storage>& to, size_t out) {
  PathVertexLanes<kFeatures, typename P::Real> vertex;
  vertex.forEach(from, [&](auto& number, const auto& column) WAVECREST_LAMBDA { number = load(column, i); });
  vertex.forEach(to, [&](const auto& number, const auto& column) WAVECREST_LAMBDA { append(number, m, column, out); });
}

// Appends the lanes of m to a wave of ends. Those of delta lobes alone are among the others: the stages that join them
// find that they carry nothing.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE void moveVertices(const Wave<typename P::Storage>& from, size_t i, Mask m,
                                   Wave<typename P::Storage>& to) {
  const size_t out = to.rays.size;
  to.rays.claim(countTrue(m));
  copyVertices<P, kFeatures>(from, i, m, to, out);
  to.setVertices(to.rays.size, to.rays.size);
}

}  // namespace

template <class P, uint32_t kFeatures>
void admitWalks(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const Chains& chains = context.chains.state->columns;
  const uint32_t* const edges = context.walk == Walk::camera ? chains.cameraEdges : chains.lightGranted;
  const size_t count = wave.rays.size;
  size_t out = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(wave.paths.lane, i), UInt(0u));
    const Mask admitted = andNot(active, gather(edges, lane) == UInt(0u));
    copyRays<kFeatures>(wave, i, admitted, wave, out);
    out += countTrue(admitted);
  }
  wave.rays.size = wave.paths.size = out;
}

template <class P, uint32_t kFeatures>
void takeEnds(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const Chains& chains = context.chains.state->columns;
  const bool camera = context.walk == Walk::camera;
  const uint32_t* const mine = camera ? chains.cameraEdges : chains.lightGranted;
  const uint32_t* const other = camera ? chains.lightEdges : chains.cameraEdges;
  Wave<typename P::Storage>& atOrigin = context.chains.ends->atOrigin;
  Wave<typename P::Storage>& atVertex = context.chains.ends->atVertex(camera);
  const size_t count = wave.rays.size;
  size_t out = 0, joinable = 0, diffuse = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(wave.paths.lane, i), UInt(0u));
    const UInt edges = gather(mine, lane);
    const Mask ended = active & (edges == UInt(context.depth));
    if (any(ended)) {
      const Mask alone = gather(other, lane) == UInt(0u);
      Mask joinsOrigin = ended & alone;
      if (camera) joinsOrigin = joinsOrigin & (gather(chains.emissionDepth, lane) == UInt(0u));
      const Mask joinsVertex = andNot(ended, alone);
      if (any(joinsOrigin)) moveVertices<P, kFeatures>(wave, i, joinsOrigin, atOrigin);
      if (any(joinsVertex)) {
        const size_t first = atVertex.rays.size;
        moveVertices<P, kFeatures>(wave, i, joinsVertex, atVertex);
        // Now the light walk is worth its while.
        for (size_t k = first; camera && k < atVertex.rays.size; ++k) {
          const uint32_t granted = atVertex.paths.lane[k];
          chains.lightGranted[granted] = chains.lightEdges[granted];
        }
      }
    }
    const Mask goesOn = active & (UInt(context.depth) < edges);
    copyVertices<P, kFeatures>(wave, i, goesOn, wave, out);
    out += countTrue(goesOn);
    joinable += countTrue(goesOn & firstLanes(std::max(i, wave.joinable) - i));
    diffuse += countTrue(goesOn & firstLanes(std::max(i, wave.diffuse) - i));
  }
  wave.setVertices(out, joinable, diffuse);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(admitWalks)
WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(takeEnds)
