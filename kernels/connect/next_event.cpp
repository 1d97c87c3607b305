// nextEvent: strategy s = 1. Samples one light point for each vertex and pushes a shadow ray with the whole
// contribution, weight included, where there is any.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]. out: ShadowRays [<= n], in that order. METHODS 2.2, 5.6.
#include "kernels/endpoints/light_sample_lanes.h"
#include "kernels/guide/guide_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/bsdf_ranges.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The vertices [begin, end), whose BSDFs are of kBsdfs; shadow rays from `out` on; where they end.
template <class P, uint32_t kFeatures, uint32_t kBsdfs>
WAVECREST_NOINLINE size_t sampleLights(const StageContext<typename P::Storage>& context,
                                       Wave<typename P::Storage>& wave, size_t begin, size_t end, size_t out) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& paths = wave.paths;
  auto& shadow = wave.shadowRays;

  for (size_t i = begin; i < end; i += kLanes) {
    const Mask active = firstLanes(end - i);
    const auto shading = loadShading<P, kBsdfs>(scene, wave, active, i);
    const UInt lane = select(active, load(paths.lane, i), UInt(0u));
    const Uniform4 u = draw(context, pathOf(context, wave, lane), Block::light);
    const UInt light = pickLight(scene, u.a, u.b);
    Uniform4 more = u;
    if constexpr (has(kFeatures, kRareLights)) {
      if (scene.environment.width != 0) more = draw(context, pathOf(context, wave, lane), Block::environment);
    }
    const auto sample = sampleLight<P, kFeatures>(scene, light, shading.position, u, more);

    const auto bsdf = shading.scattering(active, sample.direction);
    // wLight: the path's next direction could also have met the light, unless it is a delta light.
    const Real inversePdf = reciprocal(sample.pdf);
    Real wLight(0), wCamera(0);
    if (context.mis.emission) {
      Real pdf = bsdf.pdf;
      if (context.learned.guide != nullptr) pdf = mixedPdf<Real>(context, wave, active, i, sample.direction, pdf);
      wLight = select(sample.delta, Real(0), pdf * inversePdf);
    }
    if constexpr (has(kFeatures, kBidirectional)) {
      const MisSums<Real> mis = loadMis<kFeatures>(paths, i);
      wCamera = sample.emissionPdf * abs(dot(sample.direction, shading.normal)) * inversePdf *
                behindConnection(context.mis, Walk::camera, context.depth, mis, bsdf.pdfReverse);
    }
    const Real other = wLight + wCamera;
    const Real scale = bsdf.lightCosine * inversePdf * reciprocal(Real(1) + others(context.mis, other));
    const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    const Vec3<Real> contribution = throughput * bsdf.f * sample.radiance * scale;

    // Colours outside of Rec. 709 have negative channels.
    const Mask lit = active & sample.valid & (maxComponent(abs(contribution)) > Real(0));
    if (none(lit)) continue;
    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, sample.direction);
    appendShadowRays(shadow, lit, origin, sample.end, contribution, lane, out);
    if (scene.passages != nullptr) append(other, lit, shadow.others, out);
    out += countTrue(lit);
  }
  return out;
}

}  // namespace

template <class P, uint32_t kFeatures>
void nextEvent(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& shadow = wave.shadowRays;
  shadow.size = 0;
  if (context.scene->lightCount == 0) return;
  shadow.claim(wave.joinable);
  size_t out = 0;
  forEachBsdfRange<kFeatures>(wave, wave.joinable, [&](auto bsdfs, size_t begin, size_t end) WAVECREST_LAMBDA {
    out = sampleLights<P, kFeatures, decltype(bsdfs)::value>(context, wave, begin, end, out);
  });
  shadow.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(nextEvent)
