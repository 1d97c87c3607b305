// beginEyeWalks, beginLightWalks, walkPaths: the walks that make the new vertices of proposed paths (METHODS 7.6).
//
// in: the proposals' plans and kept rows. out: Rays, PathStates [<= pathCount] in the order of the plans; the rows of
// new lenses and lights. What the rays hit becomes rows in record_walks.cpp. Walks from the eye come first; a light
// walk begins only where the eye's has reached its end. Rays are traced by extend and arrive as in any method.
// Bidirectional mutations sample the BSDF; perturbations take the delta lobes that the current path took, and turn its
// directions elsewhere.
#include <algorithm>

#include "kernels/endpoints/camera_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/mutate/path_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Appends the rays of the lanes in m from `out` on; where they end. With a throughput of 1 and MIS sums of 0, arrive
// adds the unweighted radiance of a light that a walk meets.
template <uint32_t kFeatures, class S, class Real>
WAVECREST_INLINE size_t appendRay(Wave<S>& wave, Mask m, Vec3<Real> origin, Vec3<Real> direction, UInt lane,
                                  size_t out) {
  auto& rays = wave.rays;
  auto& paths = wave.paths;
  const Vec3<Real> one{Real(1), Real(1), Real(1)};
  appendVec3(origin, m, rays.originX, rays.originY, rays.originZ, out);
  appendVec3(direction, m, rays.directionX, rays.directionY, rays.directionZ, out);
  appendVec3(one, m, paths.throughputR, paths.throughputG, paths.throughputB, out);
  appendMis<kFeatures>(MisSums<Real>{Real(0), Real(0)}, m, paths, out);
  if constexpr (hasRouletteScale(kFeatures)) append(Real(1), m, paths.rouletteScale, out);
  append(lane, m, paths.lane, out);
  append(UInt(0u), m, paths.light, out);
  return out + countTrue(m);
}

template <class S>
WAVECREST_INLINE void setRays(Wave<S>& wave, size_t size) {
  wave.rays.size = wave.paths.size = size;
}

// The raster position of a new camera ray: anywhere on the film, or near that of the current path.
template <class S>
struct Raster {
  Float x, y;
  Mask onFilm;
};
template <class S>
WAVECREST_NOINLINE Raster<S> newRaster(const StageContext<S>& context, UInt lane, Mask near, const Uniform4& u) {
  const FilmWindow& film = context.film;
  const auto& headers = context.chains.paths->proposed.headers;
  const RasterArea area = rasterArea(context);
  const Float left(static_cast<float>(area.left)), top(static_cast<float>(area.top));
  Float x = mulAdd(u.a, Float(static_cast<float>(area.width)), left),
        y = mulAdd(u.b, Float(static_cast<float>(area.height)), top);
  if (any(near)) {
    // The logarithm of the offset is uniform, up to the radius of a circle that has the share kLensShare of the film.
    const double pixels = static_cast<double>(film.width) * film.height;
    const double ratio = std::max(std::sqrt(kLensShare * pixels * kInvPi) / kLensSmallest, 2.0);
    const Float offset = logarithmic(Float(static_cast<float>(kLensSmallest)), std::log(ratio), u.a);
    const SinCos<Float> angle = sinCos2Pi(u.b);
    x = select(near, mulAdd(offset, angle.cos, gather(headers.rasterX, lane)), x);
    y = select(near, mulAdd(offset, angle.sin, gather(headers.rasterY, lane)), y);
  }
  return {x, y, isWithin(area, x, y)};
}

// The direction in which a walk leaves a row, and the event there. shading: the row's surface, with wi towards where
// the walk comes from.
template <class P, uint32_t kFeatures>
WAVECREST_NOINLINE WalkStep<typename P::Real> leave(const StageContext<typename P::Storage>& context,
                                                    const ShadingLanes<P, kFeatures>& shading, Mask active, UInt lane,
                                                    UInt row) {
  using Real = typename P::Real;
  const auto& paths = *context.chains.paths;
  const UInt zero(0u), one(1u);
  const bool camera = context.walk == Walk::camera;
  const Uniform4 u = draw(context, lane, Block::scatter);
  const Mask perturbed = active & isPerturbation(gather(paths.plans.kind, lane));
  const bool perturbs = paths.current != nullptr && any(perturbed);
  // Perturbations take the delta lobe that the current path took at this row. Other mutations sample the BSDF.
  UInt event = zero;
  Mask same = noLanes();
  const UInt stride(static_cast<uint32_t>(paths.proposed.stride()));
  if (perturbs) {
    event = gather(paths.current->vertices.event, select(perturbed, row, zero) * stride + lane);
    same = perturbed & (event != zero);
  }
  WalkStep<Real> step = walkOn<P, kFeatures>(shading, active, u, same, event);
  const Mask turns = andNot(perturbed, same);
  if (!perturbs || none(turns)) return step;

  // From a row that is no delta: the current path's direction, turned by an angle. chooseAngles has drawn the angle of
  // caustic perturbations.
  const auto& v = paths.current->vertices;
  const UInt at = select(turns, row, one), next = camera ? at - one : at + one;
  const Vec3<Real> current = normalize(positionAt(v, next * stride + lane) - positionAt(v, at * stride + lane));
  Real theta = logarithmic(Real(kAngleSmallest), std::log(kAngleLargest / kAngleSmallest), to<Real>(u.b));
  if (!camera) theta = select(turns, to<Real>(gather(paths.plans.angle, lane)), theta);
  step.direction = select(turns, turned(current, theta, to<Real>(u.c)), step.direction);
  step.event = select(turns, zero, step.event);
  step.alive = (turns & active) | andNot(step.alive, turns);
  return step;
}

// Begins walks at rows that proposals keep, in the lanes of m: by the BSDF there.
template <class P, uint32_t kFeatures>
WAVECREST_NOINLINE size_t leaveKept(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                                    Mask m, UInt lane, size_t out) {
  using Real = typename P::Real;
  const auto& paths = *context.chains.paths;
  const bool camera = context.walk == Walk::camera;
  const auto& v = paths.proposed.vertices;
  const UInt zero(0u), one(1u), stride(static_cast<uint32_t>(paths.proposed.stride()));
  const UInt row = originRow(paths, context.walk, lane);
  // A light's own point has no neighbour behind it: its direction is turned, never sampled.
  const Mask surface = m & (camera ? allLanes() : !(row == zero));
  // wi: towards the neighbour that the walk would have come from, which the proposal keeps too.
  const UInt at = select(surface, row, one), previous = camera ? at + one : at - one;
  const Vec3<Real> position = positionAt(v, at * stride + lane);
  Vec3<Real> wi = positionAt(v, previous * stride + lane);
  Mask direction = noLanes();  // x_0 at infinity is a direction
  if (!camera) {
    const RecordLanes<LightRecord<typename P::Storage>> light(
        context.scene->lights, select(surface & (previous == zero), gather(v.primitive, lane), zero));
    direction = (previous == zero) & isInfinite(light(context.scene->lights->kind));
  }
  wi = select(direction, wi, wi - position);
  const auto shading = pathShading<P, kFeatures>(*context.scene, v, at * stride + lane, normalize(wi), context.walk);
  WalkStep<Real> step = leave<P, kFeatures>(context, shading, surface, lane, at);
  Vec3<Real> from = shading.position, normal = shading.normal;
  Real offset = shading.offset;
  const Mask ofLight = andNot(m, surface);
  // x_0 stays, and the direction to x_1 is turned.
  if (any(ofLight)) {
    const auto& current = paths.current->vertices;
    const Vec3<Real> x0 = positionAt(v, lane);
    const Vec3<Real> towards = normalize(positionAt(current, stride + lane) - x0);
    const Uniform4 u = draw(context, lane, Block::scatter);
    const Real theta = to<Real>(gather(paths.plans.angle, lane));
    from = select(ofLight, x0, from);
    normal = select(ofLight, normalAt(v, lane), normal);
    offset = select(ofLight, gather(v.offset, lane), offset);
    step.direction = select(ofLight, turned(towards, theta, to<Real>(u.c)), step.direction);
    step.alive = ofLight | step.alive;
  }
  // joinPaths writes the event to the row, once both walks have reached their ends.
  storeWhere(step.event, surface, camera ? paths.plans.eyeEvent : paths.plans.lightEvent, lane);
  const Vec3<Real> origin = offsetOrigin(from, normal, offset, step.direction);
  return appendRay<kFeatures>(wave, step.alive & m, origin, step.direction, lane, out);
}

// The angle by which a caustic perturbation turns: METHODS 7.6, the current path's range.
template <class P>
WAVECREST_NOINLINE void chooseAngles(const StageContext<typename P::Storage>& context, Mask m, UInt lane) {
  using Real = typename P::Real;
  auto& paths = *context.chains.paths;
  const auto& current = *paths.current;
  const CausticRange<Real> range =
      causticRange<Real>(context, current.vertices, current.stride(), gather(current.headers.edges, lane),
                         gather(paths.plans.lightKept, lane), m, lane);
  const Uniform4 u = uniform4(context.sampler, lane, static_cast<uint32_t>(Block::light), Stream::light);
  const Real theta = range.smallest * exp(to<Real>(u.a) * range.logRatio);
  storeWhere(to<Float>(theta), m, paths.plans.angle, lane);
}

// Row 0 of new light walks, from the rays that leave it: the first `count` of the wave.
template <class P, uint32_t kFeatures>
WAVECREST_NOINLINE void recordLights(const StageContext<typename P::Storage>& context,
                                     const Wave<typename P::Storage>& wave, size_t count) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  auto& paths = *context.chains.paths;
  const auto& v = paths.proposed.vertices;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(wave.paths.lane, i), UInt(0u));
    const UInt index = select(active, load(wave.paths.light, i), UInt(0u));
    const LightLanes<Real> light = loadLight(scene, index);
    const Vec3<Real> origin = loadVec3(wave.rays.originX, wave.rays.originY, wave.rays.originZ, i);
    const Vec3<Real> direction = loadVec3(wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i);
    // The vertex x_0: a position, or the direction towards an infinite light.
    Vec3<Real> normal = light.normal;
    if constexpr (has(kFeatures, kCurvedShapes)) {
      const Mask sphere = light.kind == lightKind(LightKind::sphere);
      normal = select(sphere, normalize(origin - light.p0) * light.e1.y, normal);
    }
    const Mask infinite = isInfinite(light.kind);
    const Vec3<Real> x0 = select(infinite, -direction, origin);
    // T = L n_0 / (pick pdf), so L is T times the densities over n_0.
    const auto edge = lightEdge<P, kFeatures>(scene, index, x0, normal, origin + direction);
    const Vec3<Real> throughput = loadVec3(wave.paths.throughputR, wave.paths.throughputG, wave.paths.throughputB, i);
    Vec3<Real> radiance = throughput * (edge.position * edge.firstEdge / max(edge.n0, Real(1e-20f)));
    // Headers hold the radiance of a beam without its beamFactor.
    if constexpr (has(kFeatures, kRareLights)) {
      radiance = select(isBeam(light.kind), light.radiance, radiance);
    }
    const Real zero(0);
    storeWhere(x0, active, v.positionX, v.positionY, v.positionZ, lane);
    storeWhere(normal, active, v.normalX, v.normalY, v.normalZ, lane);
    storeWhere(zero, active, v.offset, lane);
    storeWhere(index, active, v.primitive, lane);
    storeWhere(UInt(0u), active, v.event, lane);
    storeWhere(radiance, active, paths.proposed.headers.lightR, paths.proposed.headers.lightG,
               paths.proposed.headers.lightB, lane);
  }
}

}  // namespace

template <class P, uint32_t kFeatures>
void beginEyeWalks(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  auto& paths = *context.chains.paths;
  const auto& v = paths.proposed.vertices;
  const auto& headers = paths.proposed.headers;
  const CameraView& camera = context.scene->camera;
  const UInt zero(0u), stride(static_cast<uint32_t>(paths.proposed.stride()));
  const size_t count = wave.pathCount;
  wave.rays.size = wave.paths.size = wave.radiance.size = 0;
  wave.rays.claim(count);
  wave.paths.claim(count);
  wave.radiance.claim(count);
  // No lane has met a light yet.
  for (typename P::Storage* column :
       {static_cast<typename P::Storage*>(wave.radiance.red), static_cast<typename P::Storage*>(wave.radiance.green),
        static_cast<typename P::Storage*>(wave.radiance.blue)}) {
    std::fill_n(column, count, typename P::Storage{0});
  }
  size_t out = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(paths.plans.order, i), zero);
    // Lanes with a plan; newLens: those that replace the lens vertex; walks: those whose eye walk has rays.
    const UInt edges = gather(headers.edges, lane);
    const Mask planned = active & (edges != zero);
    const Mask newLens = planned & (edges < gather(paths.plans.eyeTo, lane));
    const Mask walks = planned & (gather(paths.plans.eyeRays, lane) != zero);
    if (any(newLens)) {
      // The lens as the path's last vertex.
      const Vec3<Real> origin = broadcast<Real>(camera.origin), none{Real(0), Real(0), Real(0)};
      const UInt at = select(newLens, edges, zero) * stride + lane;
      storeWhere(origin, newLens, v.positionX, v.positionY, v.positionZ, at);
      storeWhere(none, newLens, v.normalX, v.normalY, v.normalZ, at);
      storeWhere(Real(0), newLens, v.offset, at);
      storeWhere(zero, newLens, v.primitive, at);
      storeWhere(zero, newLens, v.event, at);
    }
    const Mask fromLens = newLens & walks, fromRow = andNot(walks, newLens);
    if (any(fromLens)) {
      // Rays through the film, and rays that leave a vertex the proposal keeps.
      const Uniform4 u = draw(context, lane, Block::scatter);
      const auto raster = newRaster(context, lane, isPerturbation(gather(paths.plans.kind, lane)), u);
      const Mask seen = fromLens & raster.onFilm;
      const auto ray = cameraRayAt<P>(camera, to<Real>(raster.x), to<Real>(raster.y), Float(0), Float(0));
      storeWhere(raster.x, seen, headers.rasterX, lane);
      storeWhere(raster.y, seen, headers.rasterY, lane);
      out = appendRay<kFeatures>(wave, seen, ray.origin, ray.direction, lane, out);
    }
    if (any(fromRow)) out = leaveKept<P, kFeatures>(context, wave, fromRow, select(fromRow, lane, zero), out);
  }
  setRays(wave, out);
}

template <class P, uint32_t kFeatures>
void beginLightWalks(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& paths = *context.chains.paths;
  const PathPlans& plans = paths.plans;
  const size_t count = wave.pathCount;
  // Lanes whose light walk begins at a new x_0, if the eye's walk has reached its end. Those whose walk goes on to x_1
  // come first. `lanes` is scratch here.
  uint32_t* const lanes = paths.lanes;
  size_t fresh = 0, traced = 0;
  for (const bool withRays : {true, false}) {
    for (size_t i = 0; i < count; ++i) {
      const uint32_t lane = plans.order[i];
      const bool whole = paths.proposed.headers.edges[lane] != 0 && plans.eyeReached[lane] == plans.eyeRays[lane];
      if (!whole || plans.lightKept[lane] != 0 || plans.lightWalked[lane] == 0) continue;
      if ((plans.lightRays[lane] != 0) == withRays) lanes[fresh++] = lane;
    }
    if (withRays) traced = fresh;
  }
  std::fill_n(lanes + fresh, kColumnPadding, 0u);
  // Sample emission for all of them and keep x_0. The rays of walks that end at x_0 are dropped.
  StageContext<typename P::Storage> onLights = context;
  onLights.lanes.lightPaths = lanes;
  wave.pathCount = fresh;
  generateLightPaths<P, kFeatures>(onLights, wave);
  wave.pathCount = count;
  recordLights<P, kFeatures>(context, wave, wave.rays.size);
  size_t out = wave.rays.size == 0 ? 0 : traced;
  wave.rays.size = wave.paths.size = 0;
  wave.rays.claim(count);
  wave.paths.claim(count);

  // Then the walks that begin at a row that the proposal keeps.
  const UInt zero(0u);
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(plans.order, i), zero);
    const Mask whole = active & (gather(paths.proposed.headers.edges, lane) != zero) &
                       (gather(plans.eyeReached, lane) == gather(plans.eyeRays, lane));
    const Mask walks = whole & (gather(plans.lightKept, lane) != zero) & (gather(plans.lightRays, lane) != zero);
    if (none(walks)) continue;
    const UInt mine = select(walks, lane, zero);
    const Mask caustic = walks & (gather(plans.kind, mine) == mutationCode(Mutation::caustic));
    if (any(caustic)) chooseAngles<P>(context, caustic, mine);
    out = leaveKept<P, kFeatures>(context, wave, walks, mine, out);
  }
  setRays(wave, out);
}

template <class P, uint32_t kFeatures>
void walkPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  auto& paths = *context.chains.paths;
  const uint32_t* const edges = context.walk == Walk::camera ? paths.plans.eyeRays : paths.plans.lightRays;
  const UInt zero(0u), stride(static_cast<uint32_t>(paths.proposed.stride()));
  const size_t count = wave.rays.size;
  size_t out = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const UInt lane = select(active, load(wave.paths.lane, i), zero);
    // Walks that have as many edges as planned end here, without a ray.
    const Mask goesOn = active & (UInt(context.depth) < gather(edges, lane));
    if (none(goesOn)) continue;
    auto shading = loadShading<P, kFeatures>(*context.scene, wave, active, i);
    shading.bsdf.walk = context.walk;
    const UInt row = select(goesOn, rowAt(context.walk, originRow(paths, context.walk, lane), context.depth), UInt(1u));
    const WalkStep<Real> step = leave<P, kFeatures>(context, shading, goesOn, lane, row);
    storeWhere(step.event, goesOn, paths.proposed.vertices.event, row * stride + lane);
    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, step.direction);
    out = appendRay<kFeatures>(wave, step.alive, origin, step.direction, lane, out);
  }
  setRays(wave, out);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(beginEyeWalks)
WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(beginLightWalks)
WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(walkPaths)
