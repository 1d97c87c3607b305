// SplitUInt: the lanes of a UInt kept apart as even and odd ones, for chains of 32 x 32 -> 64 bit products.
//
// The instruction sets multiply every other 32-bit lane to 64 bits. Putting the halves of the products back into place
// after each multiplication costs more than the multiplication, so a chain of them (a round function) splits once,
// works on 64-bit lanes of which only the lower half counts, and joins once. The scalar twin needs no such thing.
#pragma once

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

// The upper and lower half of a product; Word is SplitUInt, or uint32_t where all lanes agree.
template <class Word>
struct HighLow {
  Word high, low;
};
WAVECREST_INLINE HighLow<uint32_t> mulHighLow(uint32_t a, uint32_t b) {
  const uint64_t product = uint64_t{a} * b;
  return {static_cast<uint32_t>(product >> 32), static_cast<uint32_t>(product)};
}
WAVECREST_INLINE uint32_t xor3(uint32_t a, uint32_t b, uint32_t c) { return a ^ b ^ c; }

#if HWY_TARGET == HWY_SCALAR

using SplitUInt = UInt;
WAVECREST_INLINE SplitUInt split(UInt a) { return a; }
WAVECREST_INLINE UInt join(SplitUInt a) { return a; }
WAVECREST_INLINE HighLow<SplitUInt> mulHighLow(SplitUInt a, uint32_t b) {
  const HighLow<uint32_t> product = mulHighLow(hn::GetLane(a.v), b);
  return {product.high, product.low};
}

#else

using ProductTag = hn::Repartition<uint64_t, UIntTag>;

struct SplitUInt {
  hn::Vec<ProductTag> even, odd;  // the upper halves of these 64-bit lanes hold leftovers
  SplitUInt() = default;
  WAVECREST_INLINE SplitUInt(hn::Vec<ProductTag> evenLanes, hn::Vec<ProductTag> oddLanes)
      : even(evenLanes), odd(oddLanes) {}
  WAVECREST_INLINE SplitUInt(uint32_t x) : even(hn::Set(ProductTag(), x)), odd(even) {}
};

WAVECREST_INLINE SplitUInt split(UInt a) {
  const auto pairs = hn::BitCast(ProductTag(), a.v);
  return {pairs, hn::ShiftRight<32>(pairs)};
}
WAVECREST_INLINE UInt join(SplitUInt a) {
  const auto odd = hn::BitCast(UIntTag(), hn::ShiftLeft<32>(a.odd));
  return {hn::OddEven(odd, hn::BitCast(UIntTag(), a.even))};
}
WAVECREST_INLINE SplitUInt xor3(SplitUInt a, SplitUInt b, SplitUInt c) {
  return {hn::Xor3(a.even, b.even, c.even), hn::Xor3(a.odd, b.odd, c.odd)};
}
WAVECREST_INLINE HighLow<SplitUInt> mulHighLow(SplitUInt a, uint32_t b) {
  const auto factor = hn::Set(UIntTag(), b);
  const auto even = hn::MulEven(hn::BitCast(UIntTag(), a.even), factor);
  const auto odd = hn::MulEven(hn::BitCast(UIntTag(), a.odd), factor);
  return {{hn::ShiftRight<32>(even), hn::ShiftRight<32>(odd)}, {even, odd}};
}

#endif

WAVECREST_SIMD_END
