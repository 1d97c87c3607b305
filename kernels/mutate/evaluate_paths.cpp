// evaluatePaths: BSDFs and densities at the vertices of proposed paths that have new neighbours.
//
// in: plans, PathVertices; Radiance > 0 in the lanes whose paths are whole. out: those lanes, in PathMutations::lanes;
// step, eye, light and the choices of their changed rows (columns/chain_paths.h). METHODS 1.3, 1.4, 2.2, 4.1, 7.6.
//
// Whatever walks have made a path, its densities are computed here from its vertices alone, so that those of a path and
// of its mutation come from the same code.
#include <algorithm>

#include "kernels/mutate/path_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// Scattering at a vertex, in both directions. step: f c / pdf towards the light's side. Densities per solid angle;
// those of a delta lobe P eta_wo^2 |cos wo|, in one measure for both directions, with its probabilities P as choices.
template <class Real>
struct TwoWayScattering {
  Vec3<Real> step;
  Real eyePdf, lightPdf, eyeChoice, lightChoice;
};

// event: PathEvent of the vertex, which says by what lobe the path goes on. shading: with wi towards the eye.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE TwoWayScattering<typename P::Real> scatteringOf(const ShadingLanes<P, kFeatures>& shading, Mask active,
                                                                 Vec3<typename P::Real> towardsLight, UInt event) {
  using Real = typename P::Real;
  const Real zero(0);
  const auto value = shading.scattering(active, towardsLight);
  const Mask scatters = active & (value.pdf > zero);
  TwoWayScattering<Real> out{zeroUnless(scatters, value.f * (value.lightCosine / select(scatters, value.pdf, Real(1)))),
                             value.pdf, value.pdfReverse, value.pdf, value.pdfReverse};
  if constexpr (!onlyDiffuse(kFeatures)) {
    const Mask delta = active & (event != eventCode(PathEvent::scattered));
    if (any(delta)) {
      // A delta lobe cannot be evaluated: it is sampled once more, by the number that leads to it. Both densities are
      // divided by the squared index on the light's side, for etaRatio is eta_wi / eta_wo.
      const Uniform4 u{numberOfEvent<P, kFeatures>(shading.bsdf, event), Float(0), Float(0), Float(0)};
      Mask reflected = noLanes();
      const auto sample = shading.sampled(delta, u, reflected);
      const Mask found = active & (eventOf<P, kFeatures>(shading.bsdf, sample, reflected, u.a) == event);
      out.step = select(delta, zeroUnless(found, sample.weight), out.step);
      out.eyePdf = select(delta, sample.pdf * abs(sample.wo.z), out.eyePdf);
      out.lightPdf =
          select(delta, sample.pdfReverse * sample.etaRatio * sample.etaRatio * abs(shading.wi.z), out.lightPdf);
      out.eyeChoice = select(delta, sample.pdf, out.eyeChoice);
      // What a light walk chooses, given its normal, which a caustic perturbation draws anew. An absent surface has
      // none.
      const Real share = select(event == eventCode(PathEvent::passed), Real(1), shading.shareOfNormal(towardsLight));
      out.lightChoice = select(delta, sample.pdfReverse / max(share, Real(1e-6f)), out.lightChoice);
    }
  }
  return out;
}

// The rows of one block of paths.
template <class P, uint32_t kFeatures>
class Rows {
 public:
  using Real = typename P::Real;
  using S = typename P::Storage;

  WAVECREST_INLINE Rows(const StageContext<S>& context, UInt lane)
      : context_(context),
        v_(context.chains.paths->proposed.vertices),
        headers_(context.chains.paths->proposed.headers),
        stride_(static_cast<uint32_t>(context.chains.paths->proposed.stride())),
        lane_(lane),
        edges_(gather(headers_.edges, lane)) {}

  // Row r, a surface, in the lanes of m: its scattering and the densities of its neighbours made from it.
  WAVECREST_INLINE void evaluate(UInt r, Mask m) const {
    // The neighbours are row r - 1 on the light's side and row r + 1 on the eye's.
    const UInt one(1u), at = r * stride_ + lane_, previous = at - stride_, next = at + stride_;
    const Vec3<Real> x = positionAt(v_, at), towardsEye = positionAt(v_, next) - x;
    Vec3<Real> towardsLight = positionAt(v_, previous) - x;
    Real dist2 = max(length2(towardsLight), Real(1e-37f));
    towardsLight = towardsLight * reciprocalSqrt(dist2);
    Real lightCosine = abs(dot(towardsLight, normalAt(v_, previous)));
    // x_0 may be a direction, or have no surface: lightEdge knows direction, distance and cosine of the first edge.
    const Mask first = m & (r == one);
    LightEdge<Real> edge{};
    if (any(first)) {
      edge = lightEdge<P, kFeatures>(*context_.scene, select(first, gather(v_.primitive, lane_), UInt(0u)),
                                     positionAt(v_, lane_), normalAt(v_, lane_), x);
      towardsLight = select(first, edge.direction, towardsLight);
      dist2 = select(first, edge.dist2, dist2);
      lightCosine = select(first, edge.n0, lightCosine);
    }
    // Scattering between the two directions.
    const Real eyeDist2 = max(length2(towardsEye), Real(1e-37f));
    const Vec3<Real> back = towardsEye * reciprocalSqrt(eyeDist2);
    const auto shading = pathShading<P, kFeatures>(*context_.scene, v_, at, back, Walk::camera);
    auto scattering = scatteringOf<P, kFeatures>(shading, m, towardsLight, gather(v_.event, at));

    // Densities per area of the neighbours: `eye` of the one on the light's side, `light` of the other.
    const Real toArea = lightCosine / dist2;
    Real eye = scattering.eyePdf * toArea;
    if (any(first)) {
      // The step of x_1 ends at the light: f c L n_0 / (d^2 light[0]). No eye walk meets a delta light. The densities
      // of x_0 and x_1 from the light's side are those of emission.
      const Vec3<Real> radiance = gatherVec3(headers_.lightR, headers_.lightG, headers_.lightB, lane_);
      const Real overLight = zeroUnless(edge.position > Real(0), eye / max(edge.position, Real(1e-37f)));
      const Vec3<Real> emitted = radiance * edge.beam * overLight;
      scattering.step = select(first, scattering.step * emitted, scattering.step);
      eye = select(first & edge.delta, Real(0), eye);
      storeWhere(edge.position, first, v_.light, lane_);
      storeWhere(edge.firstEdge, first, v_.lightChoice, lane_);
      storeWhere(edge.firstEdge * abs(dot(towardsLight, shading.normal)) / dist2, first, v_.light, lane_ + stride_);
    }
    storeWhere(scattering.step, m, v_.stepR, v_.stepG, v_.stepB, at);
    storeWhere(scattering.eyeChoice, m, v_.eyeChoice, at);
    storeWhere(scattering.lightChoice, m, v_.lightChoice, at);
    storeWhere(eye, m, v_.eye, previous);
    storeWhere(scattering.lightPdf * abs(dot(back, normalAt(v_, next))) / eyeDist2, m, v_.light, next);
  }

  // The density, from a new lens, of the row next to it. In a path of one edge that row is x_0: the lens sees the
  // light, nothing scatters, and no other strategy makes the path.
  WAVECREST_INLINE void evaluateLens(Mask m) const {
    const UInt one(1u), last = select(m, edges_ - one, UInt(0u)), at = last * stride_ + lane_;
    const Vec3<Real> lens = positionAt(v_, at + stride_), x = positionAt(v_, at);
    Vec3<Real> direction = x - lens;
    Real dist2 = max(length2(direction), Real(1e-37f));
    direction = direction * reciprocalSqrt(dist2);
    Real cosine = abs(dot(direction, normalAt(v_, at)));
    const Mask seen = m & (edges_ == one);
    if (any(seen)) {
      const auto edge = lightEdge<P, kFeatures>(*context_.scene, select(seen, gather(v_.primitive, lane_), UInt(0u)), x,
                                                normalAt(v_, at), lens);
      direction = select(seen, edge.direction, direction);
      dist2 = select(seen, edge.dist2, dist2);
      cosine = select(seen, edge.n0, cosine);
      storeWhere(edge.position, seen, v_.light, lane_);
    }
    storeWhere(filmPdfW<P>(context_, direction) * cosine / dist2, m, v_.eye, at);
  }

 private:
  const StageContext<S>& context_;
  const PathVertices<S>& v_;
  const PathHeaders<S>& headers_;
  UInt stride_, lane_, edges_;
};

// The lanes whose paths are whole, in the order of the plans.
template <class S>
WAVECREST_INLINE void gatherLanes(PathMutations<S>& paths, const Wave<S>& wave) {
  paths.laneCount = 0;
  for (size_t i = 0; i < wave.pathCount; ++i) {
    const uint32_t lane = paths.plans.order[i];
    paths.lanes[paths.laneCount] = lane;
    paths.laneCount += wave.radiance.red[lane] > 0 ? 1 : 0;
  }
  std::fill_n(paths.lanes + paths.laneCount, kColumnPadding, 0u);
}

}  // namespace

template <class P, uint32_t kFeatures>
void evaluatePaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& paths = *context.chains.paths;
  const PathPlans& plans = paths.plans;
  gatherLanes(paths, wave);
  const UInt zero(0u), one(1u);
  for (size_t i = 0; i < paths.laneCount; i += kLanes) {
    const Mask active = firstLanes(paths.laneCount - i);
    const UInt lane = load(paths.lanes, i);
    // Rows with a new neighbour: from the last one that the light's side keeps to the first one that the eye's side
    // keeps.
    const UInt kept = gather(plans.lightKept, lane), eyeTo = gather(plans.eyeTo, lane);
    const UInt edges = gather(paths.proposed.headers.edges, lane);
    const Rows<P, kFeatures> rows(context, lane);
    const UInt end = min(eyeTo + one, edges);  // one past the last changed surface
    for (UInt row = max(select(kept == zero, zero, kept - one), one);; row = row + one) {
      const Mask m = active & (row < end);
      if (none(m)) break;
      rows.evaluate(select(m, row, one), m);
    }
    const Mask newLens = active & (edges < eyeTo);
    if (any(newLens)) rows.evaluateLens(newLens);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(evaluatePaths)
