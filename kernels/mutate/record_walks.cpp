// recordMisses, recordPathVertices: what the rays of walks meet becomes the new vertices of proposed paths
// (METHODS 7.6).
//
// in: Rays, Hits, PathStates [n] after extend, and Surfaces after arrive. out: rows of PathVertices, and how many edges
// each walk has reached.
#include "kernels/mutate/path_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

// recordMisses: a ray that leaves the scene for an infinite light, where the walk was to meet one. Between extend and
// arrive, which forgets such rays.
template <class P, uint32_t kFeatures>
void recordMisses(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  const auto& scene = *context.scene;
  if (scene.infiniteLight == kNoIndex || context.walk != Walk::camera) return;
  const auto& v = context.chains.paths->proposed.vertices;
  for (size_t i = 0; i < wave.rays.size; ++i) {
    const uint32_t lane = wave.paths.lane[i];
    if (wave.hits.primitive[i] != kMiss || context.chains.state->columns.emissionDepth[lane] != context.depth) continue;
    // Walks begin at any vertex of the path: only a path of one edge shows the light itself to the camera.
    if (scene.hidesInfinite && context.chains.paths->proposed.headers.edges[lane] == 1) continue;
    v.positionX[lane] = wave.rays.directionX[i];
    v.positionY[lane] = wave.rays.directionY[i];
    v.positionZ[lane] = wave.rays.directionZ[i];
    v.normalX[lane] = v.normalY[lane] = v.normalZ[lane] = 0;
    v.offset[lane] = 0;
    v.primitive[lane] = scene.infiniteLight;
    v.event[lane] = 0;
    context.chains.paths->plans.eyeReached[lane] = context.depth;
  }
}

template <class P, uint32_t kFeatures>
void recordPathVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& paths = *context.chains.paths;
  const auto& v = paths.proposed.vertices;
  const size_t stride = paths.proposed.stride();
  const bool camera = context.walk == Walk::camera;
  uint32_t* const reached = camera ? paths.plans.eyeReached : paths.plans.lightReached;
  for (size_t i = 0; i < wave.rays.size; i += kLanes) {
    const Mask active = firstLanes(wave.rays.size - i);
    const UInt lane = select(active, load(wave.paths.lane, i), UInt(0u));
    const UInt row = rowAt(context.walk, originRow(paths, context.walk, lane), context.depth);
    const UInt at = select(active, row, UInt(0u)) * UInt(static_cast<uint32_t>(stride)) + lane;
    const auto& surfaces = wave.surfaces;
    storeWhere(loadVec3(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i), active, v.positionX, v.positionY,
               v.positionZ, at);
    storeWhere(loadVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, i), active, v.normalX, v.normalY,
               v.normalZ, at);
    storeWhere(load(surfaces.offset, i), active, v.offset, at);
    VertexDetailLanes<typename P::Real> details;
    details.template read<kFeatures>(surfaces, [&](const auto& column) WAVECREST_LAMBDA { return load(column, i); });
    details.template forEach<kFeatures>(
        v, [&](const auto& number, const auto& column) WAVECREST_LAMBDA { storeWhere(number, active, column, at); });
    UInt primitive = select(active, load(wave.hits.primitive, i), UInt(0u));
    if (camera) {  // x_0 is a point of a light, if it is one
      const auto record = primitivesOf(*context.scene, primitive);
      const UInt light = record(context.scene->primitives->light);
      primitive = select((row == UInt(0u)) & (light != UInt(kNoIndex)), light, primitive);
      primitive = select((row == UInt(0u)) & (light == UInt(kNoIndex)), UInt(0u), primitive);
    }
    storeWhere(primitive, active, v.primitive, at);
    storeWhere(UInt(0u), active, v.event, at);
    storeWhere(UInt(context.depth), active, reached, lane);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(recordMisses)
WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(recordPathVertices)
