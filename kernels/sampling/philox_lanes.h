// Philox4x32: a counter-based generator, one 128-bit block of random bits per counter and key.
//
// Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011. Ten rounds are what the authors recommend and
// publish known-answer vectors for; seven are the fewest that pass all of BigCrush there, at 7/10 of the cost.
#pragma once

#include "kernels/simd/split_lanes.h"

WAVECREST_SIMD_BEGIN

constexpr int kPhiloxRounds = 7;

struct PhiloxKey {
  uint32_t low, high;
};
WAVECREST_INLINE PhiloxKey philoxKey(uint64_t seed) {
  return {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)};
}

// The counter, and in the end the random bits. Each word is a SplitUInt or, where all lanes agree, a uint32_t: the
// rounds then work on a plain integer, outside the caller's loop, until the word first meets one that differs per lane.
template <class A, class B, class C, class D>
struct PhiloxBlock {
  A a;
  B b;
  C c;
  D d;
};
template <class A, class B, class C, class D>  // compilers before C++20's aggregates need to be told
PhiloxBlock(A, B, C, D)->PhiloxBlock<A, B, C, D>;

template <int kRounds, class A, class B, class C, class D>
WAVECREST_INLINE auto philox4x32(PhiloxBlock<A, B, C, D> x, PhiloxKey key) {
  if constexpr (kRounds == 0) {
    return x;
  } else {
    const auto first = mulHighLow(x.a, 0xD2511F53u);
    const auto second = mulHighLow(x.c, 0xCD9E8D57u);
    const PhiloxBlock y{xor3(second.high, x.b, key.low), second.low, xor3(first.high, x.d, key.high), first.low};
    // Weyl sequence of the golden ratio and sqrt(3) - 1
    return philox4x32<kRounds - 1>(y, PhiloxKey{key.low + 0x9E3779B9u, key.high + 0xBB67AE85u});
  }
}

WAVECREST_SIMD_END
