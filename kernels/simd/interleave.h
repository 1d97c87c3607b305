// Columns to rows and back: four vectors of lanes written as one group of four after the other, and groups of four from
// anywhere read into four vectors.
#pragma once

#include <cstring>
#include <type_traits>

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

// a0 b0 c0 d0 a1 b1 ...; 4 kLanes numbers.
WAVECREST_INLINE void storeInterleaved(Float a, Float b, Float c, Float d, float* p) {
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, FloatTag(), p);
}
WAVECREST_INLINE void storeInterleaved(Double a, Double b, Double c, Double d, double* p) {
  HWY_ALIGN double values[4][kLanes]{};  // clang-tidy does not see that store fills them
  store(a, values[0]);
  store(b, values[1]);
  store(c, values[2]);
  store(d, values[3]);
  for (size_t i = 0; i < 4 * kLanes; ++i) p[i] = values[i % 4][i / 4];
}

// Records of sixteen numbers, one for each lane: numbers are set for all lanes, records are copied out lane by lane.
template <class S>
class RecordBlock {
 public:
  // Numbers 4 piece to 4 piece + 3.
  template <class Real>
  WAVECREST_INLINE void set(size_t piece, Real a, Real b, Real c, Real d) {
    storeInterleaved(a, b, c, d, pieces_[piece]);
  }
  template <class Record>
  WAVECREST_INLINE void copy(size_t lane, Record& out) const {
    static_assert(sizeof(Record) == 4 * kPieces * sizeof(S));
    S* const numbers = reinterpret_cast<S*>(&out);
    for (size_t piece = 0; piece < kPieces; ++piece) {
      std::memcpy(numbers + 4 * piece, &pieces_[piece][4 * lane], 4 * sizeof(S));
    }
  }
  // The records of the lanes in m, one after the other, which asks for the place of the one `ahead` of each.
  template <class Record>
  WAVECREST_INLINE void append(Mask m, Record* out, size_t ahead) const {
    HWY_ALIGN uint32_t source[kLanes];
    store(compress(laneIndex(), m), source);
    for (size_t k = 0, count = countTrue(m); k < count; ++k) {
      __builtin_prefetch(out + k + ahead, 1);
      copy(source[k], out[k]);
    }
  }

 private:
  static constexpr size_t kPieces = 4;
  HWY_ALIGN S pieces_[kPieces][4 * kLanes];
};

// ---- rows to columns ------------------------------------------------------------------------------------------------

template <class Real>
struct FourColumns {
  Real a, b, c, d;
};

// Lane k gets the four numbers from rowAt(k) on, of any type. One load a lane and a transposition by fours: on machines
// whose gathers are microcoded this costs less than the gather of a single column. Rows need no alignment.
#if HWY_TARGET == HWY_SCALAR
template <class RowAt>
WAVECREST_INLINE auto loadFour(const RowAt& rowAt) {
  const auto* const row = rowAt(0);
  return FourColumns<decltype(loadUnaligned(row))>{loadUnaligned(row), loadUnaligned(row + 1), loadUnaligned(row + 2),
                                                   loadUnaligned(row + 3)};
}
#else
template <class RowAt, size_t kCount = kLanes>
WAVECREST_INLINE auto loadFour(const RowAt& rowAt) {
  using T = std::remove_cvref_t<decltype(*rowAt(0))>;
  using Real = decltype(loadUnaligned(rowAt(0)));
  if constexpr (std::is_same_v<T, double>) {
    HWY_ALIGN double columns[4][kLanes];
    for (size_t k = 0; k < kLanes; ++k) {
      for (size_t column = 0; column < 4; ++column) columns[column][k] = rowAt(k)[column];
    }
    return FourColumns<Real>{load(columns[0]), load(columns[1]), load(columns[2]), load(columns[3])};
  } else {
    // The rows of lanes k, k + 4, k + 8, ..., one to each block of four numbers.
    const auto blocks = [&](size_t k) WAVECREST_LAMBDA {
      const hn::FixedTag<T, 4> row;
      if constexpr (kCount == 4) {
        return hn::LoadU(row, rowAt(k));
      } else {
        const hn::FixedTag<T, 8> pair;
        const auto low = hn::Combine(pair, hn::LoadU(row, rowAt(k + 4)), hn::LoadU(row, rowAt(k)));
        if constexpr (kCount == 8) {
          return low;
        } else {
          static_assert(kCount == 16);
          const auto high = hn::Combine(pair, hn::LoadU(row, rowAt(k + 12)), hn::LoadU(row, rowAt(k + 8)));
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
    return FourColumns<Real>{{hn::BitCast(tag, hn::InterleaveLower(wide, low01, low23))},
                             {hn::BitCast(tag, hn::InterleaveUpper(wide, low01, low23))},
                             {hn::BitCast(tag, hn::InterleaveLower(wide, high01, high23))},
                             {hn::BitCast(tag, hn::InterleaveUpper(wide, high01, high23))}};
  }
}
#endif

// The same of rows base + index[k]. Where indices are in memory for some time already, loadFour can read them there one
// by one, which costs less than taking a vector apart; not right behind the store of a vector, which it would wait for.
template <class T>
WAVECREST_INLINE auto gatherFour(const T* base, UInt index) {
  if constexpr (std::is_same_v<T, double>) {
    return FourColumns<Double>{gather(base, index), gather(base + 1, index), gather(base + 2, index),
                               gather(base + 3, index)};
  } else {
    HWY_ALIGN uint32_t start[kLanes];
    store(index, start);
    return loadFour([&](size_t k) WAVECREST_LAMBDA { return base + start[k]; });
  }
}

WAVECREST_SIMD_END
