// Columns to rows and back: vectors of lanes written as records of sixteen numbers, and groups of four numbers from
// anywhere read into four vectors.
#pragma once

#include <hwy/cache_control.h>

#include <type_traits>

#include "kernels/simd/double_lanes.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct FourColumns {
  Real a, b, c, d;
};

#if HWY_TARGET != HWY_SCALAR
// Transposes four by four numbers in each 128-bit block of four registers.
template <class V>
WAVECREST_INLINE FourColumns<V> transposeBlocks(V a, V b, V c, V d) {
  const hn::DFromV<V> tag;
  const hn::RepartitionToWide<hn::DFromV<V>> wide;
  const auto lowAB = hn::BitCast(wide, hn::InterleaveLower(tag, a, b));
  const auto lowCD = hn::BitCast(wide, hn::InterleaveLower(tag, c, d));
  const auto highAB = hn::BitCast(wide, hn::InterleaveUpper(tag, a, b));
  const auto highCD = hn::BitCast(wide, hn::InterleaveUpper(tag, c, d));
  return {hn::BitCast(tag, hn::InterleaveLower(wide, lowAB, lowCD)),
          hn::BitCast(tag, hn::InterleaveUpper(wide, lowAB, lowCD)),
          hn::BitCast(tag, hn::InterleaveLower(wide, highAB, highCD)),
          hn::BitCast(tag, hn::InterleaveUpper(wide, highAB, highCD))};
}
#endif

// ---- columns to rows ------------------------------------------------------------------------------------------------

// Records of sixteen numbers, one for each lane: numbers are set for all lanes, then records are stored.
template <class Real>
class RecordBlock {
  using S = typename Real::Storage;

 public:
  // Numbers 4 piece to 4 piece + 3.
  WAVECREST_INLINE void set(size_t piece, Real a, Real b, Real c, Real d) { pieces_[piece] = {a, b, c, d}; }
  // The records of all lanes, one after the other, aligned as wide as they are.
  template <class Record>
  WAVECREST_INLINE void store(Record* out) const {
    write<false>(out);
  }
  // The same past the caches: for what is read much later. flushStream() before another thread may read it.
  template <class Record>
  WAVECREST_INLINE void stream(Record* out) const {
    write<true>(out);
  }

 private:
  static constexpr size_t kPieces = 4;

  template <bool kStream, class Record>
  WAVECREST_INLINE void write(Record* out) const {
    static_assert(sizeof(Record) == 4 * kPieces * sizeof(S));
    S* const numbers = reinterpret_cast<S*>(out);
    if constexpr (kLanes == 1 || std::is_same_v<S, double>) {
      for (size_t piece = 0; piece < kPieces; ++piece) {
        const auto& [a, b, c, d] = pieces_[piece];
        HWY_ALIGN S columns[4][kLanes]{};  // clang-tidy does not see that store fills them
        WAVECREST_SIMD_NAMESPACE::store(a, columns[0]);
        WAVECREST_SIMD_NAMESPACE::store(b, columns[1]);
        WAVECREST_SIMD_NAMESPACE::store(c, columns[2]);
        WAVECREST_SIMD_NAMESPACE::store(d, columns[3]);
        for (size_t i = 0; i < 4 * kLanes; ++i)
          numbers[i / 4 * 4 * kPieces + 4 * piece + i % 4] = columns[i % 4][i / 4];
      }
    } else {
      writeTransposed<kStream>(numbers);
    }
  }

#if HWY_TARGET != HWY_SCALAR
  // Block b of register q of a transposed piece has the piece's numbers of lane 4 b + q.
  template <bool kStream>
  WAVECREST_INLINE void writeTransposed(float* out) const {
    const auto transposed = [](const FourColumns<Real>& p)
                                WAVECREST_LAMBDA { return transposeBlocks(p.a.v, p.b.v, p.c.v, p.d.v); };
    const auto p = transposed(pieces_[0]), q = transposed(pieces_[1]), r = transposed(pieces_[2]),
               s = transposed(pieces_[3]);
    writeEveryFourth<kStream>(p.a, q.a, r.a, s.a, out);
    writeEveryFourth<kStream>(p.b, q.b, r.b, s.b, out + 4 * kPieces);
    writeEveryFourth<kStream>(p.c, q.c, r.c, s.c, out + 2 * 4 * kPieces);
    writeEveryFourth<kStream>(p.d, q.d, r.d, s.d, out + 3 * 4 * kPieces);
  }
  // The records of lanes 0, 4, ...: block b of the four pieces is that of lane 4 b.
  template <bool kStream, class V>
  static WAVECREST_INLINE void writeEveryFourth(V p, V q, V r, V s, float* out) {
    const hn::DFromV<V> tag;
    constexpr size_t kNext = 4 * 4 * kPieces;
    const auto put = [tag](V v, float* at) WAVECREST_LAMBDA {
      if constexpr (kStream) {
        hn::Stream(v, tag, at);
      } else {
        hn::Store(v, tag, at);
      }
    };
    if constexpr (kLanes == 4) {
      put(p, out);
      put(q, out + 4);
      put(r, out + 8);
      put(s, out + 12);
    } else if constexpr (kLanes == 8) {
      put(hn::ConcatLowerLower(tag, q, p), out);
      put(hn::ConcatLowerLower(tag, s, r), out + 8);
      put(hn::ConcatUpperUpper(tag, q, p), out + kNext);
      put(hn::ConcatUpperUpper(tag, s, r), out + kNext + 8);
    } else {  // kLanes == 16
      const auto two = [put](V even, V odd, float* first) WAVECREST_LAMBDA {
        put(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(odd), even), first);
        put(hn::OddEvenBlocks(odd, hn::SwapAdjacentBlocks(even)), first + kNext);
      };
      two(hn::ConcatLowerLower(tag, r, p), hn::ConcatLowerLower(tag, s, q), out);
      two(hn::ConcatUpperUpper(tag, r, p), hn::ConcatUpperUpper(tag, s, q), out + 2 * kNext);
    }
  }
#endif

  FourColumns<Real> pieces_[kPieces];
};

// Orders what this thread has streamed before what it stores next.
WAVECREST_INLINE void flushStream() { hwy::FlushStream(); }

// ---- rows to columns ------------------------------------------------------------------------------------------------

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
    const auto columns = transposeBlocks(blocks(0), blocks(1), blocks(2), blocks(3));
    return FourColumns<Real>{{columns.a}, {columns.b}, {columns.c}, {columns.d}};
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
