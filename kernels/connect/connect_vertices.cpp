// connectVertices: strategies s >= 2, t >= 2. Joins each camera vertex with the vertex that its paired light path has
// at the context's lightDepth, and pushes a shadow ray with the weighted contribution.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the light store of the wave's light paths. out: ShadowRays
// [<= n], in the order of light vertices. METHODS 5.6 (40)-(41).
//
// Deep vertices are rare, so the pairs are listed first: 16 lanes then work on 16 pairs, whatever the depth. The list
// begins at the light vertices, which get fewer from depth to depth. Depths are called in order from 1.
#include <algorithm>

#include "kernels/columns/light_vertices.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Where each lane's camera path is in the wave; kNoIndex where it has ended. Holds for all depths of light vertices.
template <class S>
WAVECREST_INLINE void placeLanes(const StageContext<S>& context, const Wave<S>& wave) {
  uint32_t* const rayOfLane = context.light->rayOfLane();
  const uint32_t* const lane = wave.paths.lane;
  std::fill_n(rayOfLane, wave.pathCount, kNoIndex);
  for (uint32_t i = 0; i < wave.joinable; ++i) rayOfLane[lane[i]] = i;
}

// The pairs of camera vertices and vertices of the light depth that are of one lane, in the order of the latter; how
// many.
template <class S>
WAVECREST_INLINE size_t listPairs(const StageContext<S>& context, Wave<S>& wave) {
  auto& pairs = wave.pairs;
  const uint32_t *const rayOfLane = context.light->rayOfLane(), *const lanes = context.light->vertices.lane;
  const size_t first = context.light->firstOf(context.lightDepth), end = context.light->firstOf(context.lightDepth + 1);
  size_t count = 0;
  for (size_t i = first; i < end; i += kLanes) {
    const Mask active = firstLanes(end - i);
    const UInt camera = gather(rayOfLane, select(active, loadUnaligned(lanes + i), UInt(0u)));
    const Mask paired = andNot(active, camera == UInt(kNoIndex));
    if (none(paired)) continue;
    append(camera, paired, pairs.camera, count);
    append(laneIndex(static_cast<uint32_t>(i)), paired, pairs.light, count);
    count += countTrue(paired);
  }
  // Whole blocks are read: those that the list's end leaves open get pairs of the first vertices.
  storeUnaligned(UInt(0u), pairs.camera + count);
  storeUnaligned(UInt(0u), pairs.light + count);
  return count;
}

// Light vertices of a whole iteration are more than the caches hold: their rows are asked for so many pairs ahead.
constexpr size_t kRowsAhead = 128;

// Weighted contributions of the listed pairs, as shadow rays; how many.
template <class P, uint32_t kFeatures>
size_t joinPairs(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave, size_t count) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& vertices = context.light->vertices;
  auto& shadow = wave.shadowRays;
  size_t out = 0;
  size_t asked = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    for (const size_t end = std::min(i + kRowsAhead, count); asked < end; ++asked) {
      __builtin_prefetch(vertices.row + wave.pairs.light[asked]);
    }
    const Mask active = firstLanes(count - i);
    const auto zRow = gatherRows<P, kFeatures>(scene, wave.vertexRows.row, wave.surfaces, wave.pairs.camera + i);
    auto yRow = gatherRows<P, kFeatures>(scene, vertices.row, vertices, wave.pairs.light + i);
    yRow.shading.bsdf.walk = Walk::light;
    const auto &z = zRow.shading, &y = yRow.shading;

    const Vec3<Real> segment = y.position - z.position;
    const Real dist2 = length2(segment);
    const Real inverseDistance = reciprocalSqrt<P>(max(dist2, Real(1e-37f)));
    const Vec3<Real> towards = segment * inverseDistance;  // from the camera vertex to the light vertex
    const auto zBsdf = z.scattering(active, towards);
    const auto yBsdf = y.scattering(active, -towards);

    const Real inverseDist2 = inverseDistance * inverseDistance;
    const Real zCosine = abs(dot(towards, z.normal)), yCosine = abs(dot(towards, y.normal));
    const Real wLight = zBsdf.pdf * yCosine * inverseDist2 *
                        behindConnection(context.mis, context.lightDepth,
                                         MisSums<Real>{yRow.dVCM, yRow.behind, Real(0)}, yBsdf.pdfReverse);
    const Real wCamera =
        yBsdf.pdf * zCosine * inverseDist2 *
        behindConnection(context.mis, context.depth, MisSums<Real>{zRow.dVCM, zRow.behind, Real(0)}, zBsdf.pdfReverse);

    // c_z(omega_l) at the camera's end; c_y(omega_l) / n_y(omega_l) n_y(to z) at the light's (METHODS 3.9).
    const Real yFix = max(abs(y.fixCosine), Real(1e-6f));
    const Real scale = zBsdf.lightCosine * yBsdf.lightCosine * yCosine * inverseDist2 *
                       reciprocal<P>(yFix * (Real(1) + wLight + wCamera));
    const Vec3<Real> contribution = zRow.throughput * zBsdf.f * yRow.throughput * yBsdf.f * scale;

    // Points closer than the offsets that keep their segment off the surfaces cannot be told apart.
    const Real apart = Real(4) * (z.offset + y.offset);
    const Mask lit = active & (dist2 > apart * apart) & (maxComponent(contribution) > Real(0));
    if (none(lit)) continue;
    const Vec3<Real> origin = offsetOrigin(z.position, z.normal, z.offset, towards);
    const Vec3<Real> end = offsetOrigin(y.position, y.normal, y.offset, -towards);
    appendVec3(to<Float>(origin), lit, shadow.originX, shadow.originY, shadow.originZ, out);
    appendVec3(to<Float>(end - origin), lit, shadow.directionX, shadow.directionY, shadow.directionZ, out);
    appendVec3(contribution, lit, shadow.red, shadow.green, shadow.blue, out);
    append(gather(static_cast<const uint32_t*>(wave.paths.lane), load(wave.pairs.camera, i)), lit, shadow.target, out);
    out += countTrue(lit);
  }
  return out;
}

}  // namespace

template <class P, uint32_t kFeatures>
void connectVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& shadow = wave.shadowRays;
  shadow.size = 0;
  // k = len_L + 1 + len_C
  if (context.depth + context.lightDepth + 1 > context.limits.maxDepth) return;
  if (context.lightDepth == 1) placeLanes(context, wave);
  packVertexRows<kFeatures>(context, wave);

  const size_t pairs = listPairs(context, wave);
  context.counters->connections += pairs;
  shadow.claim(pairs);
  shadow.size = joinPairs<P, kFeatures>(context, wave, pairs);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(connectVertices)
