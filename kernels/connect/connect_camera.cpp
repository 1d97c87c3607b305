// connectToCamera: strategy t = 1. Joins each light vertex with the lens and pushes a shadow ray towards the pixel that
// sees it.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n] of a light walk. out: ShadowRays [<= n] in that order, whose
// targets are pixels of the film's window; or lanes, where LaneColumns::pixel is set.
// METHODS 4.3, 5.6. The contribution leaves out 1/N_L: the film divides by the number of light paths, as the average
// over passes does. Densities are per pixel whatever the reconstruction filter, so weights do not depend on it.
#include "kernels/endpoints/camera_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/bsdf_ranges.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Place on the lens (a, b) and choice of the pixel (c, d). A lane that chooses its pixel (a Markov chain) takes both
// from the numbers of its camera walk, whatever the strategy: a mutation that changes the strategy keeps the lens
// position.
template <class S>
WAVECREST_INLINE Uniform4 lensNumbers(const StageContext<S>& context, const Wave<S>& wave, UInt lane) {
  if (context.lanes.pixel == nullptr) return draw(context, pathOf(context, wave, lane), Block::light);
  const Uniform4 u = uniform4(context.sampler, lane, static_cast<uint32_t>(Block::scatter), Stream::camera);
  return {u.c, u.d, u.a, u.b};
}

// The vertices [begin, end), whose BSDFs are of kBsdfs; shadow rays from `out` on; where they end.
template <class P, uint32_t kBsdfs>
WAVECREST_NOINLINE size_t joinLens(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                                   size_t begin, size_t end, size_t out) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& paths = wave.paths;
  const FilmWindow& film = context.film;
  auto& shadow = wave.shadowRays;
  const bool choosesPlace = scene.camera.lensRadius > 0 || scene.camera.filter != FilterKind::box;

  for (size_t i = begin; i < end; i += kLanes) {
    const Mask active = firstLanes(end - i);
    auto shading = loadShading<P, kBsdfs>(scene, wave, active, i);
    shading.bsdf.walk = Walk::light;
    Uniform4 u{};  // place on the lens, choice of the pixel
    if (choosesPlace) {
      u = lensNumbers(context, wave, select(active, load(paths.lane, i), UInt(0u)));
    }
    const auto view = project<P>(scene.camera, shading.position, u);
    const SplatPixel<Real> column = splatPixel(scene.camera, view.rasterX, to<Real>(u.c));
    const SplatPixel<Real> row = splatPixel(scene.camera, view.rasterY, to<Real>(u.d));
    // Relative to the rendered rectangle; outside of it nothing is seen.
    const Real x = column.pixel - Real(static_cast<float>(film.x0)), y = row.pixel - Real(static_cast<float>(film.y0));
    const Mask onFilm = view.inFront & (x >= Real(0)) & (y >= Real(0)) & (x < Real(static_cast<float>(film.width))) &
                        (y < Real(static_cast<float>(film.height)));
    if (none(active & onFilm)) continue;

    const auto bsdf = shading.scattering(active & onFilm, view.direction);
    const Real woCosine = abs(dot(view.direction, shading.normal));
    const Real wiCosine = abs(shading.wiCosine);
    const Real pdfA = view.pdf * woCosine;
    const MisSums<Real> mis = loadMis<kBidirectional>(paths, i);
    // LT has no other strategy: its weight is 1.
    const Real wLight = pdfA * Real(context.mis.lightPaths > 0 ? 1 / context.mis.lightPaths : 0.0) *
                        behindLens(context.mis, context.depth, mis, bsdf.pdfReverse);
    // f c(omega_l) / n(omega_l): omega_l is wi, the light's side.
    const Real scale = pdfA * bsdf.lightCosine * reciprocal(max(wiCosine, Real(kSmallestCosine)) * (Real(1) + wLight)) *
                       (column.weight * row.weight);
    const Vec3<Real> contribution =
        loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i) * bsdf.f * scale;
    const Mask lit = active & onFilm & (wiCosine > Real(0)) & (maxComponent(abs(contribution)) > Real(0));
    if (none(lit)) continue;

    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, view.direction);
    const UInt pixel = toUInt(to<Float>(y)) * UInt(film.width) + toUInt(to<Float>(x));
    UInt target = pixel;
    if (context.contributesToLanes()) {
      target = select(lit, load(paths.lane, i), UInt(0u));
      storeWhere(pixel, lit, context.lanes.pixel, target);
    }
    appendShadowRays(shadow, lit, origin, view.end, contribution, target, out);
    if (scene.passages != nullptr) append(wLight, lit, shadow.others, out);
    out += countTrue(lit);
  }
  return out;
}

}  // namespace

template <class P, uint32_t kFeatures>
void connectToCamera(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& shadow = wave.shadowRays;
  shadow.size = 0;
  shadow.claim(wave.joinable);
  size_t out = 0;
  forEachBsdfRange<kFeatures>(wave, wave.joinable, [&](auto bsdfs, size_t begin, size_t end) WAVECREST_LAMBDA {
    out = joinLens<P, decltype(bsdfs)::value>(context, wave, begin, end, out);
  });
  shadow.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(connectToCamera)
