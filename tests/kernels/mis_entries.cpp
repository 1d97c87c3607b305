// The steps of the MIS recursion behind plain pointers, for mis_test.cpp.
#include "tests/kernels/mis_entries.h"

#include "kernels/mis_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

template <class P>
struct Steps {
  using S = typename P::Storage;
  using Real = typename P::Real;

  static MisSums<Real> loadSums(const MisColumns<S>& sums, size_t i) {
    return {loadUnaligned(sums.dVCM + i), loadUnaligned(sums.dVC + i)};
  }
  static void storeSums(const MisSums<Real>& mis, const MisColumns<S>& sums, size_t i) {
    storeUnaligned(mis.dVCM, sums.dVCM + i);
    storeUnaligned(mis.dVC, sums.dVC + i);
  }

  static void scatter(const MisSettings& settings, Walk walk, uint32_t depth, size_t count, const S* pdf,
                      const S* pdfReverse, const S* woCosine, const MisColumns<S>& sums) {
    for (size_t i = 0; i < count; i += kLanes) {
      storeSums(scatterMis<P, kBidirectional>(settings, walk, depth, loadSums(sums, i), loadUnaligned(pdf + i),
                                              loadUnaligned(pdfReverse + i), loadUnaligned(woCosine + i)),
                sums, i);
    }
  }
  static void scatterSpecular(size_t count, const S* jacobian, const MisColumns<S>& sums) {
    for (size_t i = 0; i < count; i += kLanes) {
      storeSums(scatterSpecularMis(loadSums(sums, i), loadUnaligned(jacobian + i)), sums, i);
    }
  }
  static void connection(const MisSettings& settings, Walk walk, uint32_t depth, size_t count,
                         const MisColumns<S>& sums, const S* pdfReverse, S* out) {
    for (size_t i = 0; i < count; i += kLanes) {
      storeUnaligned(behindConnection(settings, walk, depth, loadSums(sums, i), loadUnaligned(pdfReverse + i)),
                     out + i);
    }
  }
  static void lens(const MisSettings& settings, uint32_t depth, size_t count, const MisColumns<S>& sums,
                   const S* pdfReverse, S* out) {
    for (size_t i = 0; i < count; i += kLanes) {
      storeUnaligned(behindLens(settings, depth, loadSums(sums, i), loadUnaligned(pdfReverse + i)), out + i);
    }
  }
  static void merge(const MisSettings& settings, size_t count, const MisColumns<S>& sums, const S* pdf, S* out) {
    for (size_t i = 0; i < count; i += kLanes) {
      storeUnaligned(behindMerge(settings, loadSums(sums, i), loadUnaligned(pdf + i)), out + i);
    }
  }

  static constexpr MisKernels<S> kKernels = {scatter, scatterSpecular, connection, lens, merge};
};

constexpr MisEntries kMisEntries = {
    .lanes = kLanes, .floating = Steps<FloatPrecision>::kKernels, .doubled = Steps<DoublePrecision>::kKernels};
WAVECREST_REGISTER_ENTRIES(MisEntries, kMisEntries);

}  // namespace
WAVECREST_SIMD_END
