// scatter: chooses where each path goes on.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]. out: Rays (new), PathStates [<= n], in that order, without
// paths that were absorbed or ended by roulette. METHODS 1.4 (throughput), 1.5 (roulette), 5.5 (MIS recursion).
#include "kernels/mis_lanes.h"
#include "kernels/shade/bsdf_ranges.h"
#include "kernels/shade/guided_scatter_lanes.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/shade/survival_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// J of METHODS 5.5 for a delta lobe.
template <class P, uint32_t kBsdfs>
WAVECREST_INLINE typename P::Real specularJacobian(const ShadingLanes<P, kBsdfs>& shading,
                                                   const BsdfSample<typename P::Real>& sample,
                                                   typename P::Real woCosine) {
  using Real = typename P::Real;
  const Real cosines = abs(shading.wi.z) * reciprocal(max(abs(sample.wo.z), Real(1e-12f)));
  return sample.pdfReverse * reciprocal(sample.pdf) * woCosine * cosines * sample.etaRatio * sample.etaRatio;
}

// The features that change what scatterRange does, apart from its set of BSDFs.
constexpr uint32_t scatterFeatures(uint32_t features) {
  const uint32_t asked = kBidirectional | kShadingNormals | kTextures;
  return (features & asked) | (hasRouletteScale(features) ? uint32_t{kSpecularBsdfs} : 0u);
}

// Scatters vertices [begin, end), whose BSDFs are of kBsdfs, to `out`; where they end. Both stages share its code, and
// so do feature sets that are equal by scatterFeatures.
template <class P, uint32_t kFeatures, uint32_t kBsdfs>
WAVECREST_NOINLINE size_t scatterRange(const StageContext<typename P::Storage>& context,
                                       Wave<typename P::Storage>& wave, Lobes lobes, size_t begin, size_t end,
                                       size_t out) {
  using Real = typename P::Real;
  auto& rays = wave.rays;
  auto& paths = wave.paths;
  const bool roulette = context.depth >= context.limits.rouletteDepth;

  for (size_t i = begin; i < end; i += kLanes) {
    const Mask active = firstLanes(end - i);
    auto shading = loadShading<P, kBsdfs>(*context.scene, wave, active, i);
    shading.bsdf.walk = context.walk;
    shading.bsdf.lobes = lobes;
    const UInt lane = select(active, load(paths.lane, i), UInt(0u));
    const Uniform4 u = draw(context, pathOf(context, wave, lane), Block::scatter);
    auto sample = shading.sampled(active, u);
    // Where a render learns directions, the guide may replace the sample.
    Real slope(0), measure(0);
    if (context.learned.guide != nullptr) [[unlikely]] {
      const auto guided = guideSample<P, kBsdfs>(context, wave, i, active, lane, shading, sample);
      sample = guided.sample;
      slope = guided.slope;
      measure = guided.measure;
    }
    const Vec3<Real> direction = shading.toWorld(sample.wo);
    const Real woCosine = abs(dot(direction, shading.normal));

    const Vec3<Real> arriving = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
    Vec3<Real> throughput = arriving * sample.weight;
    // Light outside of Rec. 709 has negative channels.
    Mask alive = active & (maxComponent(abs(throughput)) > Real(0)) & (sample.pdf > Real(0));
    if (lobes == Lobes::specularOnly) alive = alive & sample.specular;
    if constexpr (has(kFeatures, kBidirectional) && has(kFeatures, kShadingNormals | kTextures)) {
      if (context.walk == Walk::light) {  // METHODS 3.9: the non-symmetry of interpolated normals (Veach 1997, 5.3)
        const Real wiCosine = max(abs(shading.wiCosine), Real(kSmallestCosine));
        throughput =
            throughput * (abs(shading.wi.z) * woCosine * reciprocal(wiCosine * max(abs(sample.wo.z), Real(1e-12f))));
      }
    }
    Real rouletteScale(1), scaleBefore(1);
    if constexpr (hasRouletteScale(kFeatures)) {
      scaleBefore = rouletteScale = load(paths.rouletteScale, i);
      if (context.walk == Walk::camera) rouletteScale = rouletteScale / (sample.etaRatio * sample.etaRatio);
    }
    if (roulette) {
      const Real carried = maxComponent(abs(throughput)) * rouletteScale;
      Real before = maxComponent(abs(arriving)) * scaleBefore;
      if (context.learned.guide != nullptr) before = carried * reciprocal(max(measure, Real(1e-12f)));
      const Real q = survival(context.survival, carried, before);
      alive = alive & (to<Real>(u.d) < q);
      throughput = throughput * reciprocal(q);
    }

    if (context.learned.records) [[unlikely]] {
      recordDirections<P>(context, wave, i, alive, lane, arriving, direction, sample.pdf, slope, sample.specular,
                          arriving * sample.weight, throughput);
    }

    const MisSums<Real> before = loadMis<kFeatures>(paths, i);
    MisSums<Real> mis = scatterMis<P, kFeatures>(context.mis, context.walk, context.depth, before, sample.pdf,
                                                 sample.pdfReverse, woCosine);
    if constexpr (!onlyDiffuse(kBsdfs)) {
      if (any(sample.specular)) {
        const auto over = scatterSpecularMis(before, specularJacobian(shading, sample, woCosine));
        mis = {select(sample.specular, over.dVCM, mis.dVCM), select(sample.specular, over.dVC, mis.dVC)};
      }
    }

    const Vec3<Real> origin = offsetOrigin(shading.position, shading.normal, shading.offset, direction);
    appendVec3(origin, alive, rays.originX, rays.originY, rays.originZ, out);
    appendVec3(direction, alive, rays.directionX, rays.directionY, rays.directionZ, out);
    appendVec3(throughput, alive, paths.throughputR, paths.throughputG, paths.throughputB, out);
    appendMis<kFeatures>(mis, alive, paths, out);
    append(lane, alive, paths.lane, out);
    if constexpr (hasRouletteScale(kFeatures)) append(rouletteScale, alive, paths.rouletteScale, out);
    out += countTrue(alive);
  }
  return out;
}

template <class P, uint32_t kFeatures>
WAVECREST_INLINE void scatterBy(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                                Lobes lobes) {
  size_t out = 0;
  forEachBsdfRange<kFeatures>(wave, wave.rays.size, [&](auto bsdfs, size_t begin, size_t end) WAVECREST_LAMBDA {
    out = scatterRange<P, scatterFeatures(kFeatures), decltype(bsdfs)::value>(context, wave, lobes, begin, end, out);
  });
  wave.rays.size = wave.paths.size = out;
}

}  // namespace

template <class P, uint32_t kFeatures>
void scatter(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  scatterBy<P, kFeatures>(context, wave, Lobes::all);
}

template <class P, uint32_t kFeatures>
void scatterSpecular(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  scatterBy<P, kFeatures>(context, wave, Lobes::specularOnly);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(scatter)
WAVECREST_INSTANTIATE_STAGE(scatterSpecular)
