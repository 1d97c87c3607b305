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

// part(v, i): the i-th half of a 32-bit register, as wide as one 64-bit register has lanes; join is its inverse.
#if HWY_TARGET == HWY_SCALAR
template <class V>
WAVECREST_INLINE V part(V v, size_t) {
  return v;
}
template <class Tag, class V>
WAVECREST_INLINE V join(Tag, const V* parts) {
  return parts[0];
}
#else
template <class V>
WAVECREST_INLINE auto part(V v, size_t i) {
  const hn::Half<hn::DFromV<V>> half;
  return i == 0 ? hn::LowerHalf(half, v) : hn::UpperHalf(half, v);
}
template <class Tag, class V>
WAVECREST_INLINE auto join(Tag tag, const V* parts) {
  return hn::Combine(tag, parts[1], parts[0]);
}
#endif

struct Double {
  using Storage = double;
  hn::Vec<DoubleTag> v[kDoubleParts];
  Double() = default;
  WAVECREST_INLINE Double(double x) {
    for (auto& part : v) part = hn::Set(DoubleTag(), x);
  }
};

template <class Function>
WAVECREST_INLINE Double mapParts(Function&& function) {
  Double result;
  for (size_t i = 0; i < kDoubleParts; ++i) result.v[i] = function(i);
  return result;
}

// A 32-bit lane mask as one 64-bit mask per register, and back.
WAVECREST_INLINE hn::Mask<DoubleTag> maskPart(Mask m, size_t i) {
  const auto lanes = hn::VecFromMask(IntTag(), hn::RebindMask(IntTag(), m.m));
  return hn::RebindMask(DoubleTag(), hn::MaskFromVec(hn::PromoteTo(LongTag(), part(lanes, i))));
}
template <class Function>
WAVECREST_INLINE Mask maskFromParts(Function&& function) {
  const hn::Rebind<uint32_t, ULongTag> narrow;
  hn::Vec<hn::Rebind<uint32_t, ULongTag>> parts[kDoubleParts];
  for (size_t i = 0; i < kDoubleParts; ++i) {
    parts[i] = hn::TruncateTo(narrow, hn::VecFromMask(ULongTag(), hn::RebindMask(ULongTag(), function(i))));
  }
  return {hn::RebindMask(FloatTag(), hn::MaskFromVec(join(UIntTag(), parts)))};
}

#define WAVECREST_DOUBLE_BINARY(NAME, OP)                                       \
  WAVECREST_INLINE Double NAME(Double a, Double b) {                            \
    return mapParts([&](size_t i) HWY_ATTR { return hn::OP(a.v[i], b.v[i]); }); \
  }
#define WAVECREST_DOUBLE_COMPARE(NAME, OP)                                           \
  WAVECREST_INLINE Mask NAME(Double a, Double b) {                                   \
    return maskFromParts([&](size_t i) HWY_ATTR { return hn::OP(a.v[i], b.v[i]); }); \
  }
#define WAVECREST_DOUBLE_UNARY(NAME, OP)                                \
  WAVECREST_INLINE Double NAME(Double a) {                              \
    return mapParts([&](size_t i) HWY_ATTR { return hn::OP(a.v[i]); }); \
  }
#define WAVECREST_DOUBLE_TERNARY(NAME, OP)                                              \
  WAVECREST_INLINE Double NAME(Double a, Double b, Double c) {                          \
    return mapParts([&](size_t i) HWY_ATTR { return hn::OP(a.v[i], b.v[i], c.v[i]); }); \
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
  return mapParts([&](size_t i) HWY_ATTR { return hn::IfThenElse(maskPart(m, i), yes.v[i], no.v[i]); });
}
WAVECREST_INLINE Double zeroUnless(Mask m, Double a) { return select(m, a, Double(0.0)); }

WAVECREST_INLINE Double toDouble(Float a) {
  return mapParts([&](size_t i) HWY_ATTR { return hn::PromoteTo(DoubleTag(), part(a.v, i)); });
}
WAVECREST_INLINE Float toFloat(Double a) {
  const hn::Rebind<float, DoubleTag> narrow;
  hn::Vec<hn::Rebind<float, DoubleTag>> parts[kDoubleParts];
  for (size_t i = 0; i < kDoubleParts; ++i) parts[i] = hn::DemoteTo(narrow, a.v[i]);
  return {join(FloatTag(), parts)};
}
WAVECREST_INLINE Float toFloat(Float a) { return a; }

WAVECREST_INLINE Double load(const double* p) {
  return mapParts([&](size_t i) HWY_ATTR { return hn::Load(DoubleTag(), p + i * kPartLanes); });
}
WAVECREST_INLINE Double loadUnaligned(const double* p) {
  return mapParts([&](size_t i) HWY_ATTR { return hn::LoadU(DoubleTag(), p + i * kPartLanes); });
}
WAVECREST_INLINE void store(Double a, double* p) {
  for (size_t i = 0; i < kDoubleParts; ++i) hn::Store(a.v[i], DoubleTag(), p + i * kPartLanes);
}
WAVECREST_INLINE void storeUnaligned(Double a, double* p) {
  for (size_t i = 0; i < kDoubleParts; ++i) hn::StoreU(a.v[i], DoubleTag(), p + i * kPartLanes);
}
WAVECREST_INLINE Double gather(const double* base, UInt index) {
  const auto lanes = hn::BitCast(IntTag(), index.v);
  return mapParts(
      [&](size_t i) HWY_ATTR { return hn::GatherIndex(DoubleTag(), base, hn::PromoteTo(LongTag(), part(lanes, i))); });
}
// Lanes with equal indices: the last one wins.
WAVECREST_INLINE void storeScattered(Double a, double* base, UInt index) {
  HWY_ALIGN double values[kLanes];
  HWY_ALIGN uint32_t indices[kLanes];
  store(a, values);
  store(index, indices);
  for (size_t i = 0; i < kLanes; ++i) base[indices[i]] = values[i];
}
WAVECREST_INLINE Double compress(Double a, Mask m) {
  HWY_ALIGN double in[kLanes];
  HWY_ALIGN double out[kLanes] = {};
  HWY_ALIGN uint32_t source[kLanes];
  store(a, in);
  store(compress(laneIndex(), m), source);
  const size_t count = countTrue(m);
  for (size_t i = 0; i < count; ++i) out[i] = in[source[i]];
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
