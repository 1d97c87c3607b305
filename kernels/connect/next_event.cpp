// nextEvent: strategy s = 1. Samples one light point for each vertex and pushes a shadow ray with the whole
// contribution, weight included, where there is any.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]. out: ShadowRays [<= n], in lane order. METHODS 2.2, 5.6.
#include "kernels/connect/light_sample_lanes.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

template <class P, uint32_t kFeatures>
void nextEvent(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& paths = wave.paths;
  auto& shadow = wave.shadowRays;
  const size_t count = wave.rays.size;
  shadow.size = 0;
  if (scene.lightCount == 0) return;
  shadow.claim(count);
  size_t out = 0;

  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const auto shading = loadShading<P, kFeatures>(scene, wave, active, i);
    const UInt lane = select(active, load(paths.lane, i), UInt(0u));
    const PixelLanes pixel = pixelsOf(context, wave, lane);
    const Uniform4 u = drawCamera(context, pixel.path, Block::light);
    const UInt light = pickLight(scene, u.a, u.b);
    const auto sample = sampleLight<P, kFeatures>(scene, light, shading.position, u);

    const Vec3<Real> gen = shading.toLocal(sample.direction);
    const auto bsdf = evalBsdf<P, kFeatures>(shading.bsdf, active, shading.fix, gen);
    // w = 1 / (1 + wLight): the light could also have been met by the BSDF's choice, unless it is a delta light.
    const Real inversePdf = reciprocal<P>(sample.pdf);
    const Real wLight = select(sample.delta, Real(0), bsdf.pdf * inversePdf);
    const Real scale = abs(gen.z) * inversePdf * reciprocal<P>(Real(1) + wLight);
    const Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    const Vec3<Real> contribution = throughput * bsdf.f * sample.radiance * scale;

    const Mask lit =
        active & sample.valid & shading.sidesAgree(sample.direction, gen) & (maxComponent(contribution) > Real(0));
    if (none(lit)) continue;
    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, sample.direction);
    appendVec3(to<Float>(origin), lit, shadow.originX, shadow.originY, shadow.originZ, out);
    appendVec3(to<Float>(sample.end - origin), lit, shadow.directionX, shadow.directionY, shadow.directionZ, out);
    appendVec3(contribution, lit, shadow.red, shadow.green, shadow.blue, out);
    append(lane, lit, shadow.target, out);
    out += countTrue(lit);
  }
  shadow.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(nextEvent)
