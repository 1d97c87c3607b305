// The MIS recursion in lanes: one set of partial sums for every method (Georgiev, "Implementing Vertex Connection and
// Merging", 2012; the constants of the strategies are in MisSettings).
//
// Weights use the balance heuristic. Walks whose only strategies are emission and next event estimation use the power
// heuristic (METHODS 5.1). Roulette is not part of any density. Path tracing needs only dVCM: without kBidirectional
// dVC does not exist.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// At vertex i, after arrival: dVCM is 1 / (area density of the generating vertex), dVC the densities of all earlier
// strategies relative to a connection at i, or to a merge where vertices are merged and never connected (METHODS 5.2).
template <class Real>
struct MisSums {
  Real dVCM, dVC;
};

template <uint32_t kFeatures, class S>
WAVECREST_INLINE auto loadMis(const PathStates<S>& paths, size_t i) {
  using Real = decltype(load(paths.dVCM, i));
  if constexpr (has(kFeatures, kBidirectional)) {
    return MisSums<Real>{load(paths.dVCM, i), load(paths.dVC, i)};
  } else {
    return MisSums<Real>{load(paths.dVCM, i), Real(0)};
  }
}
template <uint32_t kFeatures, class Real, class S>
WAVECREST_INLINE void storeMis(const MisSums<Real>& mis, PathStates<S>& paths, size_t i) {
  store(mis.dVCM, paths.dVCM, i);
  if constexpr (has(kFeatures, kBidirectional)) store(mis.dVC, paths.dVC, i);
}
template <uint32_t kFeatures, class Real, class S>
WAVECREST_INLINE void appendMis(const MisSums<Real>& mis, Mask m, PathStates<S>& paths, size_t out) {
  append(mis.dVCM, m, paths.dVCM, out);
  if constexpr (has(kFeatures, kBidirectional)) append(mis.dVC, m, paths.dVC, out);
}

// Sum of the densities of all other strategies, divided by this one's: the MIS weight is 1 / (1 + sum). With two
// strategies the power heuristic (Veach 1997, 9.2.4) squares their one ratio, which is bounded so that its square is
// finite.
template <class Real>
WAVECREST_INLINE Real others(const MisSettings& settings, Real ratio) {
  if (!settings.powerHeuristic) return ratio;
  const Real bounded = min(ratio, Real(1e18f));
  return bounded * bounded;
}

// e_i: whether the edge behind vertex `depth` could have been a connection. The switch of a sub-path's first edge (next
// event, or the lens) is already part of dVCM.
WAVECREST_INLINE double edgeSwitch(const MisSettings& mis, uint32_t depth) {
  return depth >= 2 && !mis.connect ? 0.0 : 1.0;
}

// Vertices at which a camera path can merge for the first time: it has left all others by delta lobes, which leave its
// sums at 0.
template <class Real>
WAVECREST_INLINE Mask isFirstMerge(const MisSums<Real>& mis) {
  return mis.dVC == Real(0);
}

// vmWeight m; m: whether merging at this vertex is a strategy. With firstMerges it never is at a vertex of a light walk
// that is left or connected by more than a delta lobe, as the camera's side has a vertex before it.
template <class Real>
WAVECREST_INLINE Real ifMerging(const MisSettings& settings, Walk walk, const MisSums<Real>& mis) {
  const Real weight(settings.vmWeight);
  if (!settings.firstMerges) return weight;
  return walk == Walk::light ? Real(0) : zeroUnless(isFirstMerge(mis), weight);
}

// vmWeight m + e dVCM + p_r dVC: densities of everything behind this vertex relative to joining it, as dVC is.
template <class Real>
WAVECREST_INLINE Real behindConnection(const MisSettings& settings, Walk walk, uint32_t depth, const MisSums<Real>& mis,
                                       Real pdfReverse) {
  return ifMerging(settings, walk, mis) + mulAdd(Real(edgeSwitch(settings, depth)), mis.dVCM, pdfReverse * mis.dVC);
}

// The same of a light walk's vertex that is joined with the lens, where a camera path could have begun to merge.
template <class Real>
WAVECREST_INLINE Real behindLens(const MisSettings& settings, uint32_t depth, const MisSums<Real>& mis,
                                 Real pdfReverse) {
  return Real(settings.vmWeight) + mulAdd(Real(edgeSwitch(settings, depth)), mis.dVCM, pdfReverse * mis.dVC);
}

// vcWeight dVCM + p dVC / vmWeight: the same relative to joining it by a merge. Where vcWeight is not 0, e is 1: every
// edge could have been a connection.
template <class Real>
WAVECREST_INLINE Real behindMerge(const MisSettings& settings, const MisSums<Real>& mis, Real pdf) {
  const Real perMerge(settings.connect ? settings.vcWeight : 1.0);  // 1 / vmWeight
  return mulAdd(Real(settings.vcWeight), mis.dVCM, pdf * (mis.dVC * perMerge));
}

// Scattering (34)-(36). woCosine: |wo . geometric normal|.
template <class P, uint32_t kFeatures>
WAVECREST_INLINE MisSums<typename P::Real> scatterMis(const MisSettings& settings, Walk walk, uint32_t depth,
                                                      const MisSums<typename P::Real>& mis, typename P::Real pdf,
                                                      typename P::Real pdfReverse, typename P::Real woCosine) {
  using Real = typename P::Real;
  const Real inversePdf = reciprocal(pdf);
  if constexpr (has(kFeatures, kBidirectional)) {
    return {inversePdf, woCosine * inversePdf * behindConnection(settings, walk, depth, mis, pdfReverse)};
  } else {
    return {inversePdf, Real(0)};
  }
}

// Scattering over a delta lobe (53)-(55): no strategy can take this vertex's place, and the densities behind it change
// by the ratio of the two directions' discrete densities per area. With refraction that is
// J = (P_r / P_f) |wo . N| (c_wi / c_wo) (eta_wi / eta_wo)^2, c being cosines to the shading normal.
template <class Real>
WAVECREST_INLINE MisSums<Real> scatterSpecularMis(const MisSums<Real>& mis, Real jacobian) {
  return {Real(0), mis.dVC * jacobian};
}

WAVECREST_SIMD_END
