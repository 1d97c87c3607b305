// joinPaths: joins the two walks of each proposed path and asks whether they see each other.
//
// in: plans, PathVertices; Radiance of lanes that met a light by chance. out: ShadowRays [<= pathCount] with
// contribution 1, so that after occlude Radiance is 1 in the lanes whose paths are whole; where walks need no joint it
// is 1 already. Raster positions of paths that are joined with the lens; events of the rows that are kept and left
// anew.
#include "kernels/endpoints/camera_lanes.h"
#include "kernels/extend/offset_lanes.h"
#include "kernels/mutate/path_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The light that a walk from the lens was to meet: its radiance is what arrive has added. A light that is not black has
// a positive channel; chains drop paths whose luminance is negative (weighPaths).
template <class S>
WAVECREST_INLINE void takeEmission(Wave<S>& wave, const PathHeaders<S>& headers, Mask m, UInt lane) {
  const auto radiance = gatherVec3(wave.radiance.red, wave.radiance.green, wave.radiance.blue, lane);
  using Real = decltype(radiance.x);
  storeWhere(radiance, m, headers.lightR, headers.lightG, headers.lightB, lane);
  const Real met = select(maxComponent(radiance) > Real(0), Real(1), Real(0));
  storeWhere(Vec3<Real>{met, met, met}, m, wave.radiance.red, wave.radiance.green, wave.radiance.blue, lane);
}

}  // namespace

template <class P, uint32_t kFeatures>
void joinPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  auto& paths = *context.chains.paths;
  const PathPlans& plans = paths.plans;
  const auto& v = paths.proposed.vertices;
  const auto& headers = paths.proposed.headers;
  auto& shadow = wave.shadowRays;
  const UInt zero(0u), one(1u), stride(static_cast<uint32_t>(paths.proposed.stride()));
  const size_t count = wave.pathCount;
  shadow.size = 0;
  if (scene.lightCount == 0) return;  // no path is whole
  shadow.claim(count);
  size_t out = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(plans.order, i), zero);
    const UInt edges = gather(headers.edges, lane), kept = gather(plans.lightKept, lane);
    const UInt walked = gather(plans.lightWalked, lane), eyeTo = gather(plans.eyeTo, lane);
    // Paths whose two walks reached as many vertices as planned; the last vertex of each walk gets its BSDF event.
    const Mask whole = active & (edges != zero) & (gather(plans.eyeReached, lane) == gather(plans.eyeRays, lane)) &
                       (gather(plans.lightReached, lane) == gather(plans.lightRays, lane));
    const Mask leftLight = whole & (one < kept), leftEye = whole & (eyeTo < edges);
    storeWhere(gather(plans.lightEvent, lane), leftLight, v.event, select(leftLight, kept - one, zero) * stride + lane);
    storeWhere(gather(plans.eyeEvent, lane), leftEye, v.event, select(leftEye, eyeTo, zero) * stride + lane);

    // Eye walks that met a light need no edge.
    const Mask byChance = whole & (kept == zero) & (walked == zero);
    if (any(byChance)) takeEmission(wave, headers, byChance, lane);
    const Mask joins = andNot(whole, byChance);
    if (none(joins)) continue;
    // The edge that joins the walks, from the eye's vertex z to the light's vertex y. An infinite light has a direction
    // and no position: its edge ends outside the scene.
    const UInt lightRow = select(joins, kept + walked - one, zero);
    const UInt yAt = lightRow * stride + lane, zAt = yAt + stride;
    const Vec3<Real> y = positionAt(v, yAt), z = positionAt(v, zAt);
    Vec3<Real> segment = y - z;
    const UInt index = select(joins & (lightRow == zero), gather(v.primitive, lane), zero);
    const RecordLanes<LightRecord<typename P::Storage>> record(scene.lights, index);
    const Mask infinite = (lightRow == zero) & isInfinite(record(scene.lights->kind));
    segment = select(infinite, y * Real(3 * scene.radius), segment);
    const Real zOffset = gather(v.offset, zAt), yOffset = gather(v.offset, yAt);
    const Real apart = Real(4) * (zOffset + yOffset);
    const Real dist2 = length2(segment);
    Mask lit = joins & (dist2 > apart * apart);
    // Where the eye's vertex is the lens, the edge decides the film position.
    const Mask toLens = joins & (lightRow + one == edges);
    if (any(toLens)) {
      const auto view = project<P>(scene.camera, y, Uniform4{});
      const Mask seen = view.inFront & isWithin(rasterArea(context), view.rasterX, view.rasterY);
      lit = lit & (seen | !toLens);
      storeWhere(to<Float>(view.rasterX), toLens & seen, headers.rasterX, lane);
      storeWhere(to<Float>(view.rasterY), toLens & seen, headers.rasterY, lane);
    }
    // A shadow ray from z to y, offset from both surfaces.
    const Vec3<Real> origin = offsetOrigin(z, normalAt(v, zAt), zOffset, segment);
    const Vec3<Real> near = offsetOrigin(y, normalAt(v, yAt), endOffset(yOffset, sqrt(dist2)), -segment);
    const Vec3<Real> end = select(infinite, z + segment, near);
    const Vec3<Real> visible{Real(1), Real(1), Real(1)};
    appendShadowRays(shadow, lit, origin, end, visible, lane, out);
    out += countTrue(lit);
  }
  shadow.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(joinPaths)
