// scatter: chooses where each path goes on.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]. out: Rays (new), PathStates [<= n], in lane order, without
// paths that were absorbed or ended by roulette. METHODS 1.4 (throughput), 1.5 (roulette), 5.5 (MIS recursion).
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Survival probability from the path's throughput; refraction's change of radiance is undone first, since it says
// nothing about the light that the path can still carry.
template <class Real>
WAVECREST_INLINE Real survival(Vec3<Real> throughput, Real etaScale) {
  return min(max(maxComponent(throughput) * etaScale, Real(0.05f)), Real(0.95f));
}

}  // namespace

template <class P, uint32_t kFeatures>
void scatter(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  auto& rays = wave.rays;
  auto& paths = wave.paths;
  const bool roulette = context.depth >= context.limits.rouletteDepth;
  const size_t count = rays.size;
  size_t out = 0;

  for (size_t i = 0; i < count; i += kLanes) {
    const Mask active = firstLanes(count - i);
    const auto shading = loadShading<P, kFeatures>(*context.scene, wave, active, i);
    const UInt lane = select(active, load(paths.lane, i), UInt(0u));
    const PixelLanes pixel = pixelsOf(context, wave, lane);
    const Uniform4 u = drawCamera(context, pixel.path, Block::scatter);
    const auto sample = sampleBsdf<P, kFeatures>(shading.bsdf, active, shading.fix, u);
    const Vec3<Real> direction = shading.toWorld(sample.gen);

    Vec3<Real> throughput = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i) * sample.weight;
    Mask alive = active & shading.sidesAgree(direction, sample.gen) & (maxComponent(throughput) > Real(0)) &
                 (sample.pdf > Real(0));
    Real etaScale(1);
    if constexpr (has(kFeatures, kSpecularBsdfs)) {
      // etaRatio = eta_fix / eta_gen; etaScale multiplies (eta_gen / eta_fix)^2.
      etaScale = load(paths.etaScale, i) / (sample.etaRatio * sample.etaRatio);
    }
    if (roulette) {
      const Real q = survival(throughput, etaScale);
      alive = alive & (to<Real>(u.d) < q);
      throughput = throughput * reciprocal<P>(q);
    }
    // Over a delta lobe no other strategy can replace this vertex: the recursion starts anew.
    Real dVCM = reciprocal<P>(sample.pdf);
    if constexpr (has(kFeatures, kSpecularBsdfs)) dVCM = select(sample.specular, Real(0), dVCM);

    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, direction);
    appendVec3(origin, alive, rays.originX, rays.originY, rays.originZ, out);
    appendVec3(direction, alive, rays.directionX, rays.directionY, rays.directionZ, out);
    appendVec3(throughput, alive, paths.throughputR, paths.throughputG, paths.throughputB, out);
    append(dVCM, alive, paths.dVCM, out);
    append(lane, alive, paths.lane, out);
    if constexpr (has(kFeatures, kSpecularBsdfs)) append(etaScale, alive, paths.etaScale, out);
    out += countTrue(alive);
  }
  rays.size = paths.size = out;
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(scatter)
