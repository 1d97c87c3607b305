// Double: kLanes 64-bit values, kept in two registers (one in the scalar twin), with Float's interface.
//
// Kernels are written against the precision policy's Real, which is Float or Double; masks are the same type for both.
#pragma once

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

using DoubleTag = hn::ScalableTag<double>;
using LongTag = hn::ScalableTag<int64_t>;
using ULongTag = hn::ScalableTag<uint64_t>;

constexpr size_t kPartLanes = hn::MaxLanes(DoubleTag());
constexpr size_t kDoubleParts = kLanes / kPartLanes;

// A value for each register of a Double.
template <class V>
struct Parts {
  V part[kDoubleParts];
};

// split: the halves of a 32-bit register, each as wide as one 64-bit register has lanes; join is its inverse.
//
// mapParts and forEachPart call a function with the first parts of their operands, then with the second ones. Without a
// loop, and functions must not capture operands by reference: g++ then keeps each Double in memory until it has inlined
// and unrolled all of a kernel, which took most of the time to compile it and left half of its code to copy them.
#if HWY_TARGET == HWY_SCALAR
template <class V>
WAVECREST_INLINE Parts<V> split(V v) {
  return {{v}};
}
template <class Tag, class V>
WAVECREST_INLINE V join(Tag, Parts<V> parts) {
  return parts.part[0];
}
template <class Function, class... V>
WAVECREST_INLINE auto mapParts(Function function, Parts<V>... a) {
  return Parts<decltype(function(a.part[0]...))>{{function(a.part[0]...)}};
}
template <class Function, class... V>
WAVECREST_INLINE void forEachPart(Function function, Parts<V>... a) {
  function(a.part[0]...);
}
// Where each part begins among the lanes.
constexpr Parts<size_t> kFirstLanes{{0}};
#else
template <class V>
WAVECREST_INLINE auto split(V v) {
  const hn::Half<hn::DFromV<V>> half;
  return Parts<hn::Vec<decltype(half)>>{{hn::LowerHalf(half, v), hn::UpperHalf(half, v)}};
}
template <class Tag, class V>
WAVECREST_INLINE auto join(Tag tag, Parts<V> parts) {
  return hn::Combine(tag, parts.part[1], parts.part[0]);
}
template <class Function, class... V>
WAVECREST_INLINE auto mapParts(Function function, Parts<V>... a) {
  return Parts<decltype(function(a.part[0]...))>{{function(a.part[0]...), function(a.part[1]...)}};
}
template <class Function, class... V>
WAVECREST_INLINE void forEachPart(Function function, Parts<V>... a) {
  function(a.part[0]...);
  function(a.part[1]...);
}
// Where each part begins among the lanes.
constexpr Parts<size_t> kFirstLanes{{0, kPartLanes}};
#endif

struct Double {
  using Storage = double;
  Parts<hn::Vec<DoubleTag>> v;
  Double() = default;
  WAVECREST_INLINE Double(Parts<hn::Vec<DoubleTag>> x) : v(x) {}
  WAVECREST_INLINE Double(double x)
      : v(mapParts([x](size_t) WAVECREST_LAMBDA { return hn::Set(DoubleTag(), x); }, kFirstLanes)) {}
};

// A 32-bit lane mask as one 64-bit mask per register, and back.
WAVECREST_INLINE Parts<hn::Mask<DoubleTag>> splitMask(Mask m) {
  return mapParts(
      [](auto lanes)
          WAVECREST_LAMBDA { return hn::RebindMask(DoubleTag(), hn::MaskFromVec(hn::PromoteTo(LongTag(), lanes))); },
      split(hn::VecFromMask(IntTag(), hn::RebindMask(IntTag(), m.m))));
}
WAVECREST_INLINE Mask joinMask(Parts<hn::Mask<DoubleTag>> m) {
  const auto lanes = mapParts(
      [](auto part) WAVECREST_LAMBDA {
        return hn::TruncateTo(hn::Rebind<uint32_t, ULongTag>(),
                              hn::VecFromMask(ULongTag(), hn::RebindMask(ULongTag(), part)));
      },
      m);
  return {hn::RebindMask(FloatTag(), hn::MaskFromVec(join(UIntTag(), lanes)))};
}

// Operations of one, two and three Doubles, lane by lane. Comparisons give the masks of 32-bit lanes.
#define WAVECREST_DOUBLE_BINARY(NAME, OP)                                                    \
  WAVECREST_INLINE Double NAME(Double a, Double b) {                                         \
    return mapParts([](auto x, auto y) WAVECREST_LAMBDA { return hn::OP(x, y); }, a.v, b.v); \
  }
#define WAVECREST_DOUBLE_COMPARE(NAME, OP)                                                             \
  WAVECREST_INLINE Mask NAME(Double a, Double b) {                                                     \
    return joinMask(mapParts([](auto x, auto y) WAVECREST_LAMBDA { return hn::OP(x, y); }, a.v, b.v)); \
  }
#define WAVECREST_DOUBLE_UNARY(NAME, OP)                                     \
  WAVECREST_INLINE Double NAME(Double a) {                                   \
    return mapParts([](auto x) WAVECREST_LAMBDA { return hn::OP(x); }, a.v); \
  }
#define WAVECREST_DOUBLE_TERNARY(NAME, OP)                                                                   \
  WAVECREST_INLINE Double NAME(Double a, Double b, Double c) {                                               \
    return mapParts([](auto x, auto y, auto z) WAVECREST_LAMBDA { return hn::OP(x, y, z); }, a.v, b.v, c.v); \
  }
WAVECREST_DOUBLE_BINARY(operator+, Add)
WAVECREST_DOUBLE_BINARY(operator-, Sub)
WAVECREST_DOUBLE_BINARY(operator*, Mul)
WAVECREST_DOUBLE_BINARY(operator/, Div)
WAVECREST_DOUBLE_BINARY(min, Min)
WAVECREST_DOUBLE_BINARY(max, Max)
WAVECREST_DOUBLE_BINARY(copySign, CopySign)
WAVECREST_DOUBLE_COMPARE(operator<, Lt)
WAVECREST_DOUBLE_COMPARE(operator<=, Le)
WAVECREST_DOUBLE_COMPARE(operator>, Gt)
WAVECREST_DOUBLE_COMPARE(operator>=, Ge)
WAVECREST_DOUBLE_COMPARE(operator==, Eq)
WAVECREST_DOUBLE_UNARY(operator-, Neg)
WAVECREST_DOUBLE_UNARY(abs, Abs)
WAVECREST_DOUBLE_UNARY(sqrt, Sqrt)
WAVECREST_DOUBLE_UNARY(floor, Floor)
WAVECREST_DOUBLE_UNARY(round, Round)
WAVECREST_DOUBLE_TERNARY(mulAdd, MulAdd)
WAVECREST_DOUBLE_TERNARY(negMulAdd, NegMulAdd)
WAVECREST_DOUBLE_TERNARY(mulSub, MulSub)
#undef WAVECREST_DOUBLE_BINARY
#undef WAVECREST_DOUBLE_COMPARE
#undef WAVECREST_DOUBLE_UNARY
#undef WAVECREST_DOUBLE_TERNARY

WAVECREST_INLINE Double select(Mask m, Double yes, Double no) {
  return mapParts([](auto part, auto x, auto y) WAVECREST_LAMBDA { return hn::IfThenElse(part, x, y); }, splitMask(m),
                  yes.v, no.v);
}
WAVECREST_INLINE Double zeroUnless(Mask m, Double a) { return select(m, a, Double(0.0)); }

// To Double exactly, to Float rounded.
WAVECREST_INLINE Double toDouble(Float a) {
  return mapParts([](auto half) WAVECREST_LAMBDA { return hn::PromoteTo(DoubleTag(), half); }, split(a.v));
}
WAVECREST_INLINE Float toFloat(Double a) {
  return {join(FloatTag(),
               mapParts([](auto x) WAVECREST_LAMBDA { return hn::DemoteTo(hn::Rebind<float, DoubleTag>(), x); }, a.v))};
}
WAVECREST_INLINE Float toFloat(Float a) { return a; }

// p of the aligned forms: a multiple of the size of a register.
WAVECREST_INLINE Double load(const double* p) {
  return mapParts([p](size_t first) WAVECREST_LAMBDA { return hn::Load(DoubleTag(), p + first); }, kFirstLanes);
}
WAVECREST_INLINE Double loadUnaligned(const double* p) {
  return mapParts([p](size_t first) WAVECREST_LAMBDA { return hn::LoadU(DoubleTag(), p + first); }, kFirstLanes);
}
WAVECREST_INLINE void store(Double a, double* p) {
  forEachPart([p](auto x, size_t first) WAVECREST_LAMBDA { hn::Store(x, DoubleTag(), p + first); }, a.v, kFirstLanes);
}
WAVECREST_INLINE void storeUnaligned(Double a, double* p) {
  forEachPart([p](auto x, size_t first) WAVECREST_LAMBDA { hn::StoreU(x, DoubleTag(), p + first); }, a.v, kFirstLanes);
}
// Towards 0; numbers between -2^63 and 2^63.
WAVECREST_INLINE void storeTruncated(Double a, int64_t* p) {
  forEachPart([p](auto x, size_t first)
                  WAVECREST_LAMBDA { hn::Store(hn::ConvertTo(LongTag(), x), LongTag(), p + first); },
              a.v, kFirstLanes);
}
// index: in units of doubles.
WAVECREST_INLINE Double gather(const double* base, UInt index) {
  return mapParts([base](auto half)
                      WAVECREST_LAMBDA { return hn::GatherIndex(DoubleTag(), base, hn::PromoteTo(LongTag(), half)); },
                  split(hn::BitCast(IntTag(), index.v)));
}
// Shared, not inlined: a stage compresses a dozen columns.
inline WAVECREST_NOINLINE Double compress(Double a, Mask m) {
  HWY_ALIGN double in[kLanes];
  HWY_ALIGN double out[kLanes] = {};
  HWY_ALIGN uint32_t source[kLanes];
  store(a, in);
  store(compress(laneIndex(), m), source);
  const size_t count = countTrue(m);
  for (size_t i = 0; i < count; ++i) out[i] = in[source[i]];
  return load(out);
}

// Lane i is lane order[i] of a; order: below kLanes.
inline WAVECREST_NOINLINE Double inOrder(Double a, UInt order) {
  HWY_ALIGN double in[kLanes];
  HWY_ALIGN double out[kLanes];
  HWY_ALIGN uint32_t source[kLanes];
  store(a, in);
  store(order, source);
  for (size_t i = 0; i < kLanes; ++i) out[i] = in[source[i]];
  return load(out);
}

// ---- conversion by target type --------------------------------------------------------------------------------------

template <class Real>
struct Convert;
template <>
struct Convert<Float> {
  static WAVECREST_INLINE Float from(Float a) { return a; }
  static WAVECREST_INLINE Float from(Double a) { return toFloat(a); }
};
template <>
struct Convert<Double> {
  static WAVECREST_INLINE Double from(Float a) { return toDouble(a); }
  static WAVECREST_INLINE Double from(Double a) { return a; }
};
// to<Real>(x): a Float or Double as the precision policy's Real
template <class Real, class From>
WAVECREST_INLINE Real to(From a) {
  return Convert<Real>::from(a);
}

WAVECREST_SIMD_END
