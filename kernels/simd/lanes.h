// Lane types: one value per path, as many as the instruction set has 32-bit lanes.
//
// This header and its neighbours in kernels/simd are the only code that names Highway. A kernel source is compiled once
// per instruction set (cmake/kernel_library.cmake) and sees the types below at that width: 16 lanes under AVX-512, 8
// under AVX2, 4 under SSE4 and 1 in the scalar twin. Every type has the same lane count, Double included (it holds two
// registers), so one Mask fits all of them and a kernel reads like scalar code.
//
// These types never cross a kernel's boundary: entries take pointers and counts.
#pragma once

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/simd/isa.h"

// Everything between these two lines is compiled for the chosen instruction set, in its own namespace.
#define WAVECREST_SIMD_BEGIN \
  HWY_BEFORE_NAMESPACE();    \
  namespace wavecrest::HWY_NAMESPACE {
#define WAVECREST_INLINE HWY_INLINE
#define WAVECREST_NOINLINE HWY_NOINLINE
// For lambdas, between parameters and body. Those that are not always inlined are inlined after the passes that take
// structs apart: what they get and capture then stays in memory through most of the optimiser, and a kernel takes up to
// twice as long to compile. HWY_ATTR alone is for those that are better called.
#define WAVECREST_LAMBDA HWY_ATTR __attribute__((always_inline))
#define WAVECREST_SIMD_END \
  }                        \
  HWY_AFTER_NAMESPACE();
// The namespace of this compilation's instruction set, for code outside the two lines.
#define WAVECREST_SIMD_NAMESPACE HWY_NAMESPACE

WAVECREST_SIMD_BEGIN

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using UIntTag = hn::ScalableTag<uint32_t>;
using IntTag = hn::ScalableTag<int32_t>;

constexpr size_t kLanes = hn::MaxLanes(FloatTag());

// The instruction set of this compilation.
// NOLINTBEGIN(misc-redundant-expression): HWY_TARGET is one of these constants itself
constexpr Isa kIsa = HWY_TARGET == HWY_AVX3   ? Isa::avx512
                     : HWY_TARGET == HWY_AVX2 ? Isa::avx2
                     : HWY_TARGET == HWY_SSE4 ? Isa::sse4
                                              : Isa::scalar;
// NOLINTEND(misc-redundant-expression)
static_assert(kIsa != Isa::scalar || HWY_TARGET == HWY_SCALAR, "an instruction set that kernels/simd does not know");

// ---- masks ----------------------------------------------------------------------------------------------------------

struct Mask {
  hn::Mask<FloatTag> m;
};

WAVECREST_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
WAVECREST_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
WAVECREST_INLINE Mask operator^(Mask a, Mask b) { return {hn::Xor(a.m, b.m)}; }
WAVECREST_INLINE Mask operator!(Mask a) { return {hn::Not(a.m)}; }
// a and not b
WAVECREST_INLINE Mask andNot(Mask a, Mask b) { return {hn::AndNot(b.m, a.m)}; }
WAVECREST_INLINE bool any(Mask a) { return !hn::AllFalse(FloatTag(), a.m); }
WAVECREST_INLINE bool none(Mask a) { return hn::AllFalse(FloatTag(), a.m); }
WAVECREST_INLINE bool all(Mask a) { return hn::AllTrue(FloatTag(), a.m); }
WAVECREST_INLINE size_t countTrue(Mask a) { return hn::CountTrue(FloatTag(), a.m); }
// The first n lanes; n may exceed the lane count.
WAVECREST_INLINE Mask firstLanes(size_t n) { return {hn::FirstN(FloatTag(), n)}; }
WAVECREST_INLINE Mask noLanes() { return {hn::MaskFromVec(hn::Zero(FloatTag()))}; }
WAVECREST_INLINE Mask allLanes() { return !noLanes(); }

// ---- 32-bit integers ------------------------------------------------------------------------------------------------

struct UInt {
  hn::Vec<UIntTag> v;
  UInt() = default;
  WAVECREST_INLINE UInt(hn::Vec<UIntTag> x) : v(x) {}
  WAVECREST_INLINE UInt(uint32_t x) : v(hn::Set(UIntTag(), x)) {}
};

WAVECREST_INLINE UInt operator+(UInt a, UInt b) { return {hn::Add(a.v, b.v)}; }
WAVECREST_INLINE UInt operator-(UInt a, UInt b) { return {hn::Sub(a.v, b.v)}; }
WAVECREST_INLINE UInt operator*(UInt a, UInt b) { return {hn::Mul(a.v, b.v)}; }
WAVECREST_INLINE UInt operator&(UInt a, UInt b) { return {hn::And(a.v, b.v)}; }
WAVECREST_INLINE UInt operator|(UInt a, UInt b) { return {hn::Or(a.v, b.v)}; }
WAVECREST_INLINE UInt operator^(UInt a, UInt b) { return {hn::Xor(a.v, b.v)}; }
template <int kBits>
WAVECREST_INLINE UInt shiftLeft(UInt a) {
  return {hn::ShiftLeft<kBits>(a.v)};
}
template <int kBits>
WAVECREST_INLINE UInt shiftRight(UInt a) {
  return {hn::ShiftRight<kBits>(a.v)};
}
WAVECREST_INLINE UInt shiftRight(UInt a, uint32_t bits) { return {hn::ShiftRightSame(a.v, static_cast<int>(bits))}; }
WAVECREST_INLINE Mask operator==(UInt a, UInt b) { return {hn::RebindMask(FloatTag(), hn::Eq(a.v, b.v))}; }
WAVECREST_INLINE Mask operator!=(UInt a, UInt b) { return !(a == b); }
WAVECREST_INLINE Mask operator<(UInt a, UInt b) { return {hn::RebindMask(FloatTag(), hn::Lt(a.v, b.v))}; }
WAVECREST_INLINE UInt min(UInt a, UInt b) { return {hn::Min(a.v, b.v)}; }
WAVECREST_INLINE UInt max(UInt a, UInt b) { return {hn::Max(a.v, b.v)}; }
WAVECREST_INLINE UInt select(Mask m, UInt yes, UInt no) {
  return {hn::IfThenElse(hn::RebindMask(UIntTag(), m.m), yes.v, no.v)};
}
WAVECREST_INLINE UInt xor3(UInt a, UInt b, UInt c) { return {hn::Xor3(a.v, b.v, c.v)}; }
// Where the given bit is set; 0 is the lowest.
WAVECREST_INLINE Mask hasBit(UInt a, uint32_t bit) {
  return {hn::RebindMask(FloatTag(), hn::TestBit(a.v, hn::Set(UIntTag(), 1u << bit)))};
}

// The bits in reverse order: lowest becomes highest.
WAVECREST_INLINE constexpr uint32_t reverseBits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}
WAVECREST_INLINE UInt reverseBits(UInt a) {
#if HWY_TARGET == HWY_SCALAR
  return {reverseBits(hn::GetLane(a.v))};
#else
  // Byte shuffles: reverse the bytes of each lane, then look up each half byte reversed, in the other half's place.
  const hn::Repartition<uint8_t, UIntTag> bytes;
  HWY_ALIGN constexpr uint8_t kOrder[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  HWY_ALIGN constexpr uint8_t kReversed[16] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  HWY_ALIGN constexpr uint8_t kReversedHigh[16] = {0x00, 0x80, 0x40, 0xc0, 0x20, 0xa0, 0x60, 0xe0,
                                                   0x10, 0x90, 0x50, 0xd0, 0x30, 0xb0, 0x70, 0xf0};
  const auto swapped = hn::TableLookupBytes(hn::BitCast(bytes, a.v), hn::LoadDup128(bytes, kOrder));
  const auto lowHalf = hn::And(swapped, hn::Set(bytes, uint8_t{15}));
  const auto highHalf =
      hn::And(hn::BitCast(bytes, hn::ShiftRight<4>(hn::BitCast(UIntTag(), swapped))), hn::Set(bytes, uint8_t{15}));
  return {hn::BitCast(UIntTag(), hn::Or(hn::TableLookupBytes(hn::LoadDup128(bytes, kReversedHigh), lowHalf),
                                        hn::TableLookupBytes(hn::LoadDup128(bytes, kReversed), highHalf)))};
#endif
}

// 0, 1, 2, ... from the given start. A load: hn::Iota of this Highway version writes the lanes one by one.
HWY_ALIGN inline constexpr uint32_t kLaneNumbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
static_assert(kLanes <= 16);
WAVECREST_INLINE UInt laneIndex(uint32_t start = 0) {
  return {hn::Add(hn::Load(UIntTag(), kLaneNumbers), hn::Set(UIntTag(), start))};
}

// ---- float ----------------------------------------------------------------------------------------------------------

struct Float {
  using Storage = float;
  hn::Vec<FloatTag> v;
  Float() = default;
  WAVECREST_INLINE Float(hn::Vec<FloatTag> x) : v(x) {}
  WAVECREST_INLINE Float(float x) : v(hn::Set(FloatTag(), x)) {}
  WAVECREST_INLINE explicit Float(double x) : Float(static_cast<float>(x)) {}
  WAVECREST_INLINE Float(int x) : Float(static_cast<float>(x)) {}
};

WAVECREST_INLINE Float operator+(Float a, Float b) { return {hn::Add(a.v, b.v)}; }
WAVECREST_INLINE Float operator-(Float a, Float b) { return {hn::Sub(a.v, b.v)}; }
WAVECREST_INLINE Float operator*(Float a, Float b) { return {hn::Mul(a.v, b.v)}; }
WAVECREST_INLINE Float operator/(Float a, Float b) { return {hn::Div(a.v, b.v)}; }
WAVECREST_INLINE Float operator-(Float a) { return {hn::Neg(a.v)}; }
WAVECREST_INLINE Mask operator<(Float a, Float b) { return {hn::Lt(a.v, b.v)}; }
WAVECREST_INLINE Mask operator<=(Float a, Float b) { return {hn::Le(a.v, b.v)}; }
WAVECREST_INLINE Mask operator>(Float a, Float b) { return {hn::Gt(a.v, b.v)}; }
WAVECREST_INLINE Mask operator>=(Float a, Float b) { return {hn::Ge(a.v, b.v)}; }
WAVECREST_INLINE Mask operator==(Float a, Float b) { return {hn::Eq(a.v, b.v)}; }
// a * b + c, with one rounding where the instruction set has it
WAVECREST_INLINE Float mulAdd(Float a, Float b, Float c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
// c - a * b
WAVECREST_INLINE Float negMulAdd(Float a, Float b, Float c) { return {hn::NegMulAdd(a.v, b.v, c.v)}; }
// a * b - c
WAVECREST_INLINE Float mulSub(Float a, Float b, Float c) { return {hn::MulSub(a.v, b.v, c.v)}; }
WAVECREST_INLINE Float abs(Float a) { return {hn::Abs(a.v)}; }
WAVECREST_INLINE Float min(Float a, Float b) { return {hn::Min(a.v, b.v)}; }
WAVECREST_INLINE Float max(Float a, Float b) { return {hn::Max(a.v, b.v)}; }
WAVECREST_INLINE Float sqrt(Float a) { return {hn::Sqrt(a.v)}; }
WAVECREST_INLINE Float floor(Float a) { return {hn::Floor(a.v)}; }
// To the nearest integer, halves to even.
WAVECREST_INLINE Float round(Float a) { return {hn::Round(a.v)}; }
WAVECREST_INLINE Float copySign(Float magnitude, Float sign) { return {hn::CopySign(magnitude.v, sign.v)}; }
WAVECREST_INLINE Float select(Mask m, Float yes, Float no) { return {hn::IfThenElse(m.m, yes.v, no.v)}; }
WAVECREST_INLINE Float zeroUnless(Mask m, Float a) { return {hn::IfThenElseZero(m.m, a.v)}; }
// About 11 to 14 bits, then one Newton step: 1 to 2 ulp.
WAVECREST_INLINE Float approximateReciprocal(Float a) {
  const auto guess = hn::ApproximateReciprocal(a.v);
  return {hn::Mul(guess, hn::NegMulAdd(a.v, guess, hn::Set(FloatTag(), 2.0f)))};
}

WAVECREST_INLINE UInt bits(Float a) { return {hn::BitCast(UIntTag(), a.v)}; }
WAVECREST_INLINE Float fromBits(UInt a) { return {hn::BitCast(FloatTag(), a.v)}; }
// Exact below 2^24. Values must be below 2^31.
WAVECREST_INLINE Float toFloat(UInt a) { return {hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), a.v))}; }
// Truncates; a must lie in [0, 2^31).
WAVECREST_INLINE UInt toUInt(Float a) { return {hn::BitCast(UIntTag(), hn::ConvertTo(IntTag(), a.v))}; }

WAVECREST_INLINE float leastLane(Float a) { return hn::GetLane(hn::MinOfLanes(FloatTag(), a.v)); }
WAVECREST_INLINE float greatestLane(Float a) { return hn::GetLane(hn::MaxOfLanes(FloatTag(), a.v)); }

// ---- memory ---------------------------------------------------------------------------------------------------------
// Pointers of the aligned forms are multiples of the vector size: column blocks are.

WAVECREST_INLINE Float load(const float* p) { return {hn::Load(FloatTag(), p)}; }
WAVECREST_INLINE UInt load(const uint32_t* p) { return {hn::Load(UIntTag(), p)}; }
WAVECREST_INLINE Float loadUnaligned(const float* p) { return {hn::LoadU(FloatTag(), p)}; }
WAVECREST_INLINE UInt loadUnaligned(const uint32_t* p) { return {hn::LoadU(UIntTag(), p)}; }
WAVECREST_INLINE void store(Float a, float* p) { hn::Store(a.v, FloatTag(), p); }
WAVECREST_INLINE void store(UInt a, uint32_t* p) { hn::Store(a.v, UIntTag(), p); }
WAVECREST_INLINE void storeUnaligned(Float a, float* p) { hn::StoreU(a.v, FloatTag(), p); }
WAVECREST_INLINE void storeUnaligned(UInt a, uint32_t* p) { hn::StoreU(a.v, UIntTag(), p); }

WAVECREST_INLINE Float gather(const float* base, UInt index) {
  return {hn::GatherIndex(FloatTag(), base, hn::BitCast(IntTag(), index.v))};
}
WAVECREST_INLINE UInt gather(const uint32_t* base, UInt index) {
  return {hn::GatherIndex(UIntTag(), base, hn::BitCast(IntTag(), index.v))};
}
// Of kLanes numbers, aligned. index: below kLanes.
WAVECREST_INLINE UInt lookUp(const uint32_t* numbers, UInt index) {
  const UIntTag tag;
  return {hn::TableLookupLanes(hn::Load(tag, numbers), hn::IndicesFromVec(tag, index.v))};
}
// Lane i is lane order[i] of a; order: below kLanes.
WAVECREST_INLINE UInt inOrder(UInt a, UInt order) {
  const UIntTag tag;
  return {hn::TableLookupLanes(a.v, hn::IndicesFromVec(tag, order.v))};
}
WAVECREST_INLINE Float inOrder(Float a, UInt order) { return fromBits(inOrder(bits(a), order)); }

// The 32-bit items where m holds, moved to the front in order; what follows them is not defined.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
// For each mask of up to eight lanes, those that it holds and then the others, in order. Highway's own tables are local
// to its functions, and g++ copies the whole of them, up to a kilobyte, to the stack at every call.
inline constexpr auto kLanesInFront = [] {
  std::array<std::array<uint8_t, 8>, 256> orders{};
  for (size_t mask = 0; mask < orders.size(); ++mask) {
    size_t at = 0;
    for (const size_t held : {1u, 0u}) {
      for (size_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane & 1) == held) orders[mask][at++] = static_cast<uint8_t>(lane);
      }
    }
  }
  return orders;
}();
template <class Tag>
WAVECREST_INLINE hn::Vec<Tag> moveToFront(Tag tag, hn::Vec<Tag> items, hn::Mask<Tag> m) {
  const hn::RebindToUnsigned<Tag> numbers;
  uint8_t maskBits[8] = {};
  hn::StoreMaskBits(tag, m, maskBits);
  const auto order = hn::PromoteTo(numbers, hn::LoadU(hn::Rebind<uint8_t, Tag>(), kLanesInFront[maskBits[0]].data()));
  return hn::TableLookupLanes(items, hn::IndicesFromVec(tag, order));
}
#else
template <class Tag>
WAVECREST_INLINE hn::Vec<Tag> moveToFront(Tag, hn::Vec<Tag> items, hn::Mask<Tag> m) {
  return hn::Compress(items, m);
}
#endif

// The lanes of a where m holds, moved to the front in order. Compaction is compress followed by an ordinary store into
// padded columns: the store-compressed instruction is microcoded on some machines and several times slower.
WAVECREST_INLINE Float compress(Float a, Mask m) { return {moveToFront(FloatTag(), a.v, m.m)}; }
WAVECREST_INLINE UInt compress(UInt a, Mask m) { return {moveToFront(UIntTag(), a.v, hn::RebindMask(UIntTag(), m.m))}; }

// The order that puts the lanes of m in front, in order, and those of `rest` at the end, backwards: the first of them
// is the last lane. No lane is in both.
WAVECREST_INLINE UInt splitOrder(Mask m, Mask rest) {
  const UInt backwards = UInt(static_cast<uint32_t>(kLanes - 1)) - laneIndex();
  return select(firstLanes(countTrue(m)), compress(laneIndex(), m), inOrder(compress(laneIndex(), rest), backwards));
}

WAVECREST_SIMD_END
