// Columns to rows and back: four vectors of lanes written as one group of four after the other, and groups of four from
// anywhere read into four vectors.
#pragma once

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

// a0 b0 c0 d0 a1 b1 ...; 4 kLanes numbers.
WAVECREST_INLINE void storeInterleaved(Float a, Float b, Float c, Float d, float* p) {
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, FloatTag(), p);
}
WAVECREST_INLINE void storeInterleaved(Double a, Double b, Double c, Double d, double* p) {
  HWY_ALIGN double values[4][kLanes];
  store(a, values[0]);
  store(b, values[1]);
  store(c, values[2]);
  store(d, values[3]);
  for (size_t i = 0; i < 4 * kLanes; ++i) p[i] = values[i % 4][i / 4];
}

// ---- rows to columns ------------------------------------------------------------------------------------------------

template <class Real>
struct FourColumns {
  Real a, b, c, d;
};

// Lane i gets the four numbers from base[index[i]] on. One load a lane and a transposition by fours: on machines whose
// gathers are microcoded this costs less than the gather of a single column. Rows need no alignment.
#if HWY_TARGET == HWY_SCALAR
template <class T>
WAVECREST_INLINE auto gatherFour(const T* base, UInt index) {
  using Real = decltype(gather(base, index));
  return FourColumns<Real>{gather(base, index), gather(base + 1, index), gather(base + 2, index),
                           gather(base + 3, index)};
}
#else
template <class T, size_t kCount = kLanes>
WAVECREST_INLINE auto gatherFour(const T* base, UInt index) {
  HWY_ALIGN uint32_t start[kLanes];
  store(index, start);
  // The rows of lanes k, k + 4, k + 8, ..., one to each block of four numbers.
  const auto blocks = [&](size_t k) WAVECREST_LAMBDA {
    const hn::FixedTag<T, 4> row;
    if constexpr (kCount == 4) {
      return hn::LoadU(row, base + start[k]);
    } else {
      const hn::FixedTag<T, 8> pair;
      const auto low = hn::Combine(pair, hn::LoadU(row, base + start[k + 4]), hn::LoadU(row, base + start[k]));
      if constexpr (kCount == 8) {
        return low;
      } else {
        static_assert(kCount == 16);
        const auto high = hn::Combine(pair, hn::LoadU(row, base + start[k + 12]), hn::LoadU(row, base + start[k + 8]));
        return hn::Combine(hn::FixedTag<T, kCount>(), high, low);
      }
    }
  };
  const hn::ScalableTag<T> tag;
  const hn::RepartitionToWide<hn::ScalableTag<T> > wide;
  const auto row0 = blocks(0), row1 = blocks(1), row2 = blocks(2), row3 = blocks(3);
  const auto low01 = hn::BitCast(wide, hn::InterleaveLower(tag, row0, row1));
  const auto low23 = hn::BitCast(wide, hn::InterleaveLower(tag, row2, row3));
  const auto high01 = hn::BitCast(wide, hn::InterleaveUpper(tag, row0, row1));
  const auto high23 = hn::BitCast(wide, hn::InterleaveUpper(tag, row2, row3));
  using Real = decltype(gather(base, index));
  return FourColumns<Real>{{hn::BitCast(tag, hn::InterleaveLower(wide, low01, low23))},
                           {hn::BitCast(tag, hn::InterleaveUpper(wide, low01, low23))},
                           {hn::BitCast(tag, hn::InterleaveLower(wide, high01, high23))},
                           {hn::BitCast(tag, hn::InterleaveUpper(wide, high01, high23))}};
}
#endif
#if HWY_TARGET != HWY_SCALAR
WAVECREST_INLINE FourColumns<Double> gatherFour(const double* base, UInt index) {
  return {gather(base, index), gather(base + 1, index), gather(base + 2, index), gather(base + 3, index)};
}
#endif

WAVECREST_SIMD_END
