// What scatter does where a render learns directions: the mixture of BSDF and guide, and the records that a guide is
// learned from. METHODS 12.1, 12.2.
#pragma once

#include "kernels/guide/guide_lanes.h"
#include "kernels/shade/shading_lanes.h"

WAVECREST_SIMD_BEGIN

// sample: its pdf is the mixture's, and of a delta lobe the mixture's discrete probability. slope: (p_bsdf - p_guide) /
// p, by which a greater share of the BSDF would change the logarithm of p. measure: what survival goes by, the worth of
// the path where it is known, else the albedo, f c / p_bsdf without refraction's change of radiance: what the BSDF
// alone would leave, whoever drew, as the guide leads dark paths to light.
template <class Real>
struct GuidedSample {
  BsdfSample<Real> sample;
  Real slope, measure;
};

// eta_wi / eta_wo of directions that the guide chose through a rough boundary: roulette alone asks for it. 1 in blends,
// whose parts may have different ones.
template <class P, uint32_t kBsdfs>
WAVECREST_INLINE typename P::Real guidedEtaRatio(const ShadingLanes<P, kBsdfs>& shading, Mask drawn,
                                                 typename P::Real woCosine) {
  using Real = typename P::Real;
  if constexpr (has(kBsdfs, kLayeredBsdfs)) {
    const auto is = [&](BsdfKind kind)
                        WAVECREST_LAMBDA { return shading.bsdf.kind == UInt(static_cast<uint32_t>(kind)); };
    Mask rough = is(BsdfKind::roughDielectric) | is(BsdfKind::beckmannDielectric);
    if constexpr (has(kBsdfs, kCompoundBsdfs)) {
      rough = rough | is(BsdfKind::anisotropicDielectric) | is(BsdfKind::anisotropicBeckmannDielectric) |
              is(BsdfKind::principled);
    }
    const Mask refracted = drawn & rough & (shading.wi.z * woCosine < Real(0));
    if (any(refracted)) {
      const Real eta = shading.bsdf.eta();
      return select(refracted, select(shading.wi.z > Real(0), reciprocal(eta), eta), Real(1));
    }
  }
  return Real(1);
}

// Worth of the paths at the vertices [i, i + kLanes), as GuideView says; 0 where it is not known. luminance: of their
// throughput.
template <class S>
WAVECREST_INLINE Float worthOf(const GuideView& guide, const Wave<S>& wave, Mask active, size_t i, UInt lane, UInt cell,
                               Float luminance) {
  if (guide.perBrightness == nullptr) return Float(0);
  const Mask joinable = active & firstLanes(wave.joinable - std::min(i, wave.joinable));
  const UInt run =
      shiftRight<kWorthRunBits>(shiftRight(lane, wave.iterationBits) + UInt(static_cast<uint32_t>(wave.firstPath)));
  const Float worth = luminance * gather(guide.roots, select(joinable, cell, UInt(0u))) *
                      gather(guide.perBrightness, select(joinable, run, UInt(0u)));
  return zeroUnless(joinable, worth);
}

// sample: what the BSDF drew. Lanes whose number says so go where the guide draws instead. Copies of the arguments: a
// reference would keep them in memory in scatter as a whole.
template <class P, uint32_t kBsdfs>
WAVECREST_NOINLINE GuidedSample<typename P::Real> guideSample(const StageContext<typename P::Storage>& context,
                                                              const Wave<typename P::Storage>& wave, size_t i,
                                                              Mask active, UInt lane, ShadingLanes<P, kBsdfs> shading,
                                                              BsdfSample<typename P::Real> sample) {
  using Real = typename P::Real;
  const GuideView& guide = *context.learned.guide;
  GuidedSample<Real> out{sample, Real(0), Real(0)};
  const GuideLanes at(guide, wave, active, i);
  const auto& paths = wave.paths;
  const Vec3<Real> arriving = loadVec3(paths.throughputR, paths.throughputG, paths.throughputB, i);
  const Float worth = worthOf(guide, wave, active, i, lane, at.cell, to<Float>(luminanceOf(arriving)));
  const auto measureOf = [&](Real albedo) WAVECREST_LAMBDA {
    return guide.decidesSurvival ? select(to<Real>(worth) > Real(0), to<Real>(worth), albedo) : albedo;
  };
  const Real own = maxComponent(sample.weight) * reciprocal(sample.etaRatio * sample.etaRatio);
  out.measure = measureOf(own);
  const Mask guided = active & at.draws();
  if (none(guided)) return out;
  // Which of the two draws, and the guide's direction.
  const Uniform4 u = uniform4(context.sampler, pathOf(context, wave, lane), 4 * context.depth, Stream::guide);
  const Mask drawn = guided & (u.a >= at.share);
  const Vec3<Real> chosen = normalize(to<Real>(drawFromGuide(guide, at.cell, u)));
  const auto value = shading.scattering(drawn, chosen);
  const Mask specular = andNot(sample.specular, drawn);
  const Vec3<Real> direction = select(drawn, chosen, shading.toWorld(sample.wo));
  const Real pdfBsdf = select(drawn, value.pdf, sample.pdf);
  const Real pdfGuide =
      zeroUnless(andNot(guided, specular), to<Real>(guideDensity(guide, at.cell, to<Float>(direction))));
  // The mixture. Draws of the BSDF that failed stay failed.
  const Real share = to<Real>(at.share);
  const Real pdf = share * pdfBsdf + (Real(1) - share) * pdfGuide;
  const Mask failed = andNot(sample.pdf <= Real(0), drawn);
  const Real inversePdf = reciprocal(max(pdf, Real(1e-30f)));
  const Vec3<Real> weight =
      select(drawn, value.f * (value.lightCosine * inversePdf), sample.weight * (pdfBsdf * inversePdf));
  const Vec3<Real> wo = shading.toLocal(chosen);
  const Real albedo = maxComponent(value.f) * value.lightCosine * reciprocal(max(value.pdf, Real(1e-30f)));
  const Real etaRatio = guidedEtaRatio(shading, drawn, wo.z);
  out.slope = zeroUnless(guided, (pdfBsdf - pdfGuide) * inversePdf);
  out.measure = measureOf(select(drawn, albedo * reciprocal(etaRatio * etaRatio), own));
  out.sample = {select(drawn, wo, sample.wo),
                select(guided, weight, sample.weight),
                select(andNot(guided, failed), pdf, sample.pdf),
                select(drawn, value.pdfReverse, sample.pdfReverse),
                select(drawn, etaRatio, sample.etaRatio),
                specular};
  return out;
}

// Leaves a record of each vertex in m that goes on, before its path does. throughput: at the vertex, before scattering.
// before, after: throughput after scattering, before and after roulette. pdf, slope: of the direction.
template <class P>
WAVECREST_NOINLINE void recordDirections(const StageContext<typename P::Storage>& context,
                                         Wave<typename P::Storage>& wave, size_t i, Mask m, UInt lane,
                                         Vec3<typename P::Real> throughput, Vec3<typename P::Real> direction,
                                         typename P::Real pdf, typename P::Real slope, Mask specular,
                                         Vec3<typename P::Real> before, Vec3<typename P::Real> after) {
  using Real = typename P::Real;
  if (context.depth > kRecordedDepths) return;
  const auto carried = to<Float>(luminanceOf(throughput));
  m = m & firstLanes(wave.joinable - std::min(i, wave.joinable)) & (carried > Float(0));
  if (none(m)) return;
  const UInt cell = select(m, load(wave.cells.cell, i), UInt(0u));
  const SquarePoint at = toSquare(to<Float>(direction));
  const Vec3<Real> radiance =
      gatherVec3(wave.radiance.red, wave.radiance.green, wave.radiance.blue, select(m, lane, UInt(0u)));
  auto& records = wave.directions;
  const size_t out = records.claim(countTrue(m));
  append(lane, m, records.lane, out);
  append(shiftLeft<kGuideBinBits>(cell) + binOf(at.u, at.v), m, records.bin, out);
  append(to<Float>(luminanceOf(radiance)), m, records.before, out);
  append(Float(1) / carried, m, records.inverseThroughput, out);
  // A delta lobe is no place in the histogram.
  append(zeroUnless(!specular, to<Float>(pdf) * at.solidAngle), m, records.pdf, out);
  append(to<Float>(slope), m, records.slope, out);
  append(to<Float>(maxComponent(abs(before)) * reciprocal(maxComponent(abs(after)))), m, records.survival, out);
  append(context.depth == 1 ? worthOf(*context.learned.guide, wave, m, i, lane, cell, carried) : Float(0), m,
         records.worth, out);
}

WAVECREST_SIMD_END
