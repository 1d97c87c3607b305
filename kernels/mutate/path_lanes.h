// Rows of explicit paths in lanes: reading and writing vertices, and the way a walk leaves one.
#pragma once

#include <cmath>
#include <utility>

#include "kernels/columns/chain_paths.h"
#include "kernels/columns/chains.h"
#include "kernels/endpoints/camera_lanes.h"
#include "kernels/endpoints/light_lanes.h"
#include "kernels/endpoints/scene_box_lanes.h"
#include "kernels/mutate/path_law.h"
#include "kernels/shade/shading_lanes.h"

WAVECREST_SIMD_BEGIN

WAVECREST_INLINE UInt eventCode(PathEvent event) { return UInt(static_cast<uint32_t>(event)); }
WAVECREST_INLINE UInt mutationCode(Mutation kind) { return UInt(static_cast<uint32_t>(kind)); }

// Mutations that keep the events of a path and perturb its directions.
WAVECREST_INLINE Mask isPerturbation(UInt kind) {
  return (kind == mutationCode(Mutation::lens)) | (kind == mutationCode(Mutation::multiChain)) |
         (kind == mutationCode(Mutation::caustic));
}

// Calls function(a, b) for each column that two records of the same kind hold.
template <class Record, class Function, size_t... kIndex>
WAVECREST_INLINE void forEachColumnOf(Record& from, Record& to, Function&& function, std::index_sequence<kIndex...>) {
  const auto a = from.all();
  const auto b = to.all();
  const auto visit = [&](const auto& in, const auto& out) WAVECREST_LAMBDA {
    if (in.needed()) function(in, out);
  };
  (visit(std::get<kIndex>(a), std::get<kIndex>(b)), ...);
}
template <class Record, class Function>
WAVECREST_INLINE void forEachColumn(Record& from, Record& to, Function&& function) {
  constexpr size_t kCount = std::tuple_size_v<decltype(from.all())>;
  forEachColumnOf(from, to, function, std::make_index_sequence<kCount>());
}

template <class S>
WAVECREST_INLINE auto positionAt(const PathVertices<S>& v, UInt at) {
  return gatherVec3(v.positionX, v.positionY, v.positionZ, at);
}
template <class S>
WAVECREST_INLINE auto normalAt(const PathVertices<S>& v, UInt at) {
  return gatherVec3(v.normalX, v.normalY, v.normalZ, at);
}

// Rows of the wave's walks: where each begins, and which way it goes.
template <class S>
WAVECREST_INLINE UInt originRow(const PathMutations<S>& paths, Walk walk, UInt lane) {
  const UInt zero(0u), one(1u);
  if (walk == Walk::light) {
    const UInt kept = gather(paths.plans.lightKept, lane);
    return select(kept == zero, zero, kept - one);
  }
  const UInt edges = gather(paths.proposed.headers.edges, lane), to = gather(paths.plans.eyeTo, lane);
  return min(to, edges);  // a new lens is row `edges`
}
WAVECREST_INLINE UInt rowAt(Walk walk, UInt origin, uint32_t depth) {
  return walk == Walk::light ? origin + UInt(depth) : origin - UInt(depth);
}

// A surface vertex, with `wi` the direction to the neighbour that a walk comes from.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE ShadingLanes<P, kFeatures> pathShading(const SceneView<typename P::Storage>& scene,
                                                        const PathVertices<typename P::Storage>& v, UInt at,
                                                        Vec3<typename P::Real> wi, Walk walk) {
  using Real = typename P::Real;
  const Vec3<Real> normal = normalAt(v, at);
  const VertexLanes<Real> vertex{.position = positionAt(v, at),
                                 .wi = wi,
                                 .normal = normal,
                                 .offset = gather(v.offset, at),
                                 .material = materialOf(scene, gather(v.primitive, at)),
                                 .details = readDetails<kFeatures>(v, normal, [&](const auto& column) WAVECREST_LAMBDA {
                                   return gather(column, at);
                                 })};
  auto shading = shadingOf<P, kFeatures>(scene, vertex);
  shading.bsdf.walk = walk;
  return shading;
}

// ---- how a walk goes on ---------------------------------------------------------------------------------------------

// The number that makes sampling take the delta lobe of an event, if the surface has it: lobes share [0, 1) in the
// order reflection, refraction, absence of the surface.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE Float numberOfEvent(const BsdfInputOf<P, kFeatures>& bsdf, UInt event) {
  const Float last(0x1.fffffep-1f);
  Float refracts = last;
  if constexpr (has(kFeatures, kLayeredBsdfs)) refracts = last * min(to<Float>(bsdf.opacity()), Float(1));
  return select(event == eventCode(PathEvent::reflected), Float(0),
                select(event == eventCode(PathEvent::refracted), refracts, last));
}

// The event that sampling by the number u.a led to, to the side of the normal that `reflected` says.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE UInt eventOf(const BsdfInputOf<P, kFeatures>& bsdf, const BsdfSample<typename P::Real>& sample,
                              Mask reflected, [[maybe_unused]] Float number) {
  using Real = typename P::Real;
  UInt event = select(reflected, eventCode(PathEvent::reflected), eventCode(PathEvent::refracted));
  if constexpr (has(kFeatures, kLayeredBsdfs)) {
    const Real opacity = bsdf.opacity();
    event = select((opacity < Real(1)) & (to<Real>(number) >= opacity), eventCode(PathEvent::passed), event);
  }
  return select(sample.specular, event, eventCode(PathEvent::scattered));
}

template <class Real>
struct WalkStep {
  Vec3<Real> direction;
  UInt event;
  Mask alive;
};

// From a vertex to the next: by the BSDF; where `same` holds by the delta lobe of `event`.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE WalkStep<typename P::Real> walkOn(const ShadingLanes<P, kFeatures>& shading, Mask active, Uniform4 u,
                                                   Mask same, UInt event) {
  using Real = typename P::Real;
  u.a = select(same, numberOfEvent<P, kFeatures>(shading.bsdf, event), u.a);
  Mask reflected = noLanes();
  const auto sample = shading.sampled(active, u, reflected);
  WalkStep<Real> step{shading.toWorld(sample.wo), eventOf<P, kFeatures>(shading.bsdf, sample, reflected, u.a),
                      noLanes()};
  step.alive =
      active & (maxComponent(sample.weight) > Real(0)) & (sample.pdf > Real(0)) & (!same | (step.event == event));
  return step;
}

// A direction turned by the angle theta, about itself by a fraction of a full turn.
template <class Real>
WAVECREST_INLINE Vec3<Real> turned(Vec3<Real> direction, Real theta, Real turn) {
  const SinCos<Real> polar = sinCos(theta), azimuth = sinCos2Pi(turn);
  return normalize(
      Frame<Real>::fromNormal(direction).toWorld({polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos}));
}
// smallest to smallest times ratio, uniform in the logarithm.
template <class Real>
WAVECREST_INLINE Real logarithmic(Real smallest, double logRatio, Real u) {
  return smallest * exp(u * Real(logRatio));
}

// ---- the ends of a path ---------------------------------------------------------------------------------------------

// Emission at x_0 towards x_1, and the densities of METHODS 2.2; `position` in the measure of x_0, `firstEdge` per
// solid angle there, or of infinite lights per area across the ray.
template <class Real>
struct LightEdge {
  Vec3<Real> direction;  // unit, from x_1 to x_0
  Real dist2, n0;        // 1 where the light has no place, or no surface
  Real position, firstEdge;
  Vec3<Real> beam;  // factor of a spot's or projector's radiance
  Mask delta, infinite;
};
template <class P, uint32_t kFeatures>
WAVECREST_INLINE LightEdge<typename P::Real> lightEdge(const SceneView<typename P::Storage>& scene, UInt index,
                                                       Vec3<typename P::Real> x0, Vec3<typename P::Real> normal,
                                                       Vec3<typename P::Real> x1) {
  using Real = typename P::Real;
  const LightLanes<Real> light = loadLight(scene, index);
  const Real one(1), zero(0);
  const Vec3<Real> segment = x0 - x1;
  const Real length = max(length2(segment), Real(1e-37f));
  LightEdge<Real> edge{
      segment * reciprocalSqrt(length), length, zero, zero, zero, {one, one, one}, noLanes(), isInfinite(light.kind)};
  edge.n0 = max(-dot(edge.direction, normal), zero);
  edge.position = light.pick * light.inverseArea;
  edge.firstEdge = edge.n0 * Real(kInvPi);
  const Mask point = light.kind == lightKind(LightKind::point);
  Mask noPlace = point;
  if constexpr (has(kFeatures, kRareLights)) {
    const Mask beam = isBeam(light.kind);
    if (any(beam)) {
      noPlace = noPlace | beam;
      edge.beam = select(beam, beamFactor<P, kFeatures>(scene, light, -edge.direction), edge.beam);
      edge.firstEdge = select(beam, beamPdfW(light, -dot(edge.direction, light.normal)), edge.firstEdge);
    }
    edge.delta = light.kind == lightKind(LightKind::directional);
  }
  edge.firstEdge = select(point, Real(kInvPi / 4), edge.firstEdge);
  edge.n0 = select(noPlace | edge.infinite, one, edge.n0);
  edge.position = select(noPlace | edge.delta, light.pick, edge.position);
  edge.delta = edge.delta | noPlace;
  if (any(edge.infinite)) {
    Real pdfW(kInvPi / 4);
    if constexpr (has(kFeatures, kRareLights)) {
      if (scene.environment.width != 0) pdfW = mapPdfW(scene.environment, mapPoint(scene.environment, x0));
    }
    edge.direction = select(edge.infinite, x0, edge.direction);
    edge.dist2 = select(edge.infinite, one, edge.dist2);
    edge.position = select(andNot(edge.infinite, edge.delta), light.pick * pdfW, edge.position);
    edge.firstEdge = select(edge.infinite, reciprocal(projectedArea<Real>(scene, x0)), edge.firstEdge);
  }
  return edge;
}

// Angles by which caustic perturbations of a path turn: as far as those of the lens move x_{k-1} in the image. The
// distribution is uniform in the logarithm, from `smallest` over a range of `logRatio`.
template <class Real>
struct CausticRange {
  Real smallest, logRatio;
};
// start: the first row that is made anew. Lanes outside of m get some range.
template <class Real, class S>
WAVECREST_INLINE CausticRange<Real> causticRange(const StageContext<S>& context, const PathVertices<S>& v,
                                                 size_t rowStride, UInt edges, UInt start, Mask m, UInt lane) {
  const UInt zero(0u), one(1u), stride(static_cast<uint32_t>(rowStride));
  const auto edgeFrom = [&](UInt row) WAVECREST_LAMBDA {
    return sqrt(length2(positionAt(v, (row + one) * stride + lane) - positionAt(v, row * stride + lane)));
  };
  const UInt last = select(m, edges - one, one);
  Real toLight(0);
  for (UInt row = select(m, start - one, zero);; row = row + one) {
    const Mask counts = m & (row < last);
    if (none(counts)) break;
    toLight = toLight + zeroUnless(counts, edgeFrom(select(counts, row, zero)));
  }
  const Real ratio = edgeFrom(select(m, last, zero)) / max(toLight, Real(1e-20f));
  const double pixels = static_cast<double>(context.film.width) * context.film.height;
  const double largest = std::max(std::sqrt(kLensShare * pixels * kInvPi), 2 * kLensSmallest);
  const double perPixel = 1 / context.scene->camera.pixelDistance;
  const Real theta2 = min(ratio * Real(largest * perPixel), Real(kAngleLimit));
  const Real theta1 = min(ratio * Real(kLensSmallest * perPixel), theta2 * Real(0.5f));
  return {theta1, log(theta2 / max(theta1, Real(1e-30f)))};
}

// ---- the film -------------------------------------------------------------------------------------------------------

// The raster positions that paths are made for: the rendered rectangle, and around it whatever the reconstruction
// filters of its pixels reach.
struct RasterArea {
  double left, top, width, height;
  double area() const { return width * height; }
};
template <class S>
inline RasterArea rasterArea(const StageContext<S>& context) {
  const FilmWindow& film = context.film;
  const double margin = std::max(filterRadius(context.scene->camera) - 0.5, 0.0);
  return {film.x0 - margin, film.y0 - margin, film.width + 2 * margin, film.height + 2 * margin};
}
// Whether raster positions lie in it.
template <class Real>
WAVECREST_INLINE Mask isWithin(const RasterArea& area, Real x, Real y) {
  return (x >= Real(area.left)) & (y >= Real(area.top)) & (x < Real(area.left + area.width)) &
         (y < Real(area.top + area.height));
}

// Density per solid angle of directions from the lens over the raster area.
template <class P>
WAVECREST_INLINE typename P::Real filmPdfW(const StageContext<typename P::Storage>& context,
                                           Vec3<typename P::Real> direction) {
  using Real = typename P::Real;
  return cameraPdf<P>(context.scene->camera, direction) * Real(1 / rasterArea(context).area());
}

// What the film weighs a path by: the sum of the filters of all pixels at its raster position, and the share of the
// raster area that is film. 1 for the box.
template <class Real, class S>
WAVECREST_INLINE Real filmWeight(const StageContext<S>& context, Float rasterX, Float rasterY) {
  const CameraView& camera = context.scene->camera;
  if (camera.filter == FilterKind::box) return Real(1);
  const double pixels = static_cast<double>(context.film.width) * context.film.height;
  const Float any(0);
  const Float sum = splatPixel(camera, rasterX, any).weight * splatPixel(camera, rasterY, any).weight;
  return to<Real>(sum) * Real(rasterArea(context).area() / pixels);
}

WAVECREST_SIMD_END
