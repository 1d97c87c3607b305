// connectVertices: strategies s >= 2, t >= 2. Joins each camera vertex with the vertex that its paired light path has
// at the context's lightDepth, and pushes a shadow ray with the weighted contribution.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the light store of the wave's light paths. out: ShadowRays
// [<= n], in lane order. METHODS 5.6 (40)-(41).
//
// Deep light vertices are rare, so the pairs are first packed: 16 lanes then work on 16 pairs, whatever the depth. The
// packing begins at the light vertices, which get fewer from depth to depth. Depths are called in order from 1.
//
// The light's end comes in order and its columns are copied; the camera's end is read as a row. Neither is gathered
// column by column, which would cost several times the arithmetic.
#include <algorithm>

#include "kernels/shade/light_vertex_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Where each lane's camera path is in the wave; kNoIndex where it has ended. Holds for all depths of light vertices.
template <class S>
WAVECREST_INLINE void placeLanes(const StageContext<S>& context, const Wave<S>& wave) {
  uint32_t* const rayOfLane = context.light->rayOfLane();
  const uint32_t* const lane = wave.paths.lane;
  std::fill_n(rayOfLane, wave.pathCount, kNoIndex);
  for (uint32_t i = 0; i < wave.rays.size; ++i) rayOfLane[lane[i]] = i;
}

// Weighted contributions of packed pairs, as shadow rays from index `out` on; returns the index after the last.
template <class P, uint32_t kFeatures>
size_t joinPacked(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                  PackedLightVertices<P, kFeatures>& packed, size_t out) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  auto& shadow = wave.shadowRays;
  packed.close();
  for (size_t i = 0; i < packed.size(); i += kLanes) {
    const Mask active = firstLanes(packed.size() - i);
    const auto row = gatherRows<P, kFeatures>(scene, wave, packed.camera(i));
    const auto& z = row.shading;
    const auto y = packed.shading(scene, i, active);

    const Vec3<Real> segment = y.position - z.position;
    const Real dist2 = length2(segment);
    const Real inverseDistance = reciprocalSqrt<P>(max(dist2, Real(1e-37f)));
    const Vec3<Real> towards = segment * inverseDistance;  // from the camera vertex to the light vertex
    const auto zBsdf = z.scattering(active, towards);
    const auto yBsdf = y.scattering(active, -towards);

    const Real inverseDist2 = inverseDistance * inverseDistance;
    const Real zCosine = abs(dot(towards, z.normal)), yCosine = abs(dot(towards, y.normal));
    const Real wLight = zBsdf.pdf * yCosine * inverseDist2 *
                        behindConnection(context.mis, context.lightDepth, packed.mis(i), yBsdf.pdfReverse);
    const Real wCamera =
        yBsdf.pdf * zCosine * inverseDist2 *
        behindConnection(context.mis, context.depth, MisSums<Real>{row.dVCM, row.dVC, Real(0)}, zBsdf.pdfReverse);

    // c_z(omega_l) at the camera's end; c_y(omega_l) / n_y(omega_l) n_y(to z) at the light's (METHODS 3.9).
    const Real yFix = max(abs(y.fixCosine), Real(1e-6f));
    const Real scale = zBsdf.lightCosine * yBsdf.lightCosine * yCosine * inverseDist2 *
                       reciprocal<P>(yFix * (Real(1) + wLight + wCamera));
    const Vec3<Real> contribution = row.throughput * zBsdf.f * packed.throughput(i) * yBsdf.f * scale;

    // Points closer than the offsets that keep their segment off the surfaces cannot be told apart.
    const Real apart = Real(4) * (z.offset + y.offset);
    const Mask lit = active & (dist2 > apart * apart) & (maxComponent(contribution) > Real(0));
    if (none(lit)) continue;
    const Vec3<Real> origin = offsetOrigin(z.position, z.normal, z.offset, towards);
    const Vec3<Real> end = offsetOrigin(y.position, y.normal, y.offset, -towards);
    appendVec3(to<Float>(origin), lit, shadow.originX, shadow.originY, shadow.originZ, out);
    appendVec3(to<Float>(end - origin), lit, shadow.directionX, shadow.directionY, shadow.directionZ, out);
    appendVec3(contribution, lit, shadow.red, shadow.green, shadow.blue, out);
    append(packed.lane(i), lit, shadow.target, out);
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
  packVertexRows(*context.scene, wave);

  const auto& vertices = context.light->vertices;
  const size_t first = context.light->firstOf(context.lightDepth), end = context.light->firstOf(context.lightDepth + 1);
  shadow.claim(std::min(end - first, wave.rays.size));
  PackedLightVertices<P, kFeatures> packed;
  size_t out = 0;
  const auto join = [&] {
    context.counters->connections += packed.size();
    out = joinPacked<P, kFeatures>(context, wave, packed, out);
    packed.clear();
  };
  for (size_t i = first; i < end; i += kLanes) {
    const Mask active = firstLanes(end - i);
    const UInt lane = select(active, loadUnaligned(vertices.lane + i), UInt(0u));
    const UInt camera = gather(static_cast<const uint32_t*>(context.light->rayOfLane()), lane);
    const Mask paired = andNot(active, camera == UInt(kNoIndex));
    if (none(paired)) continue;
    if (!packed.hasRoom()) join();
    packed.push(vertices, i, paired, camera);
  }
  join();
  shadow.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(connectVertices)
