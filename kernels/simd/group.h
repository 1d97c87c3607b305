// Lane types of a fixed count: kCount values of one thing, such as a node's children or a leaf's triangles, whatever
// the instruction set's own lane count. Where that is smaller, a group takes several registers.
#pragma once

#include <algorithm>

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

// How the values lie in registers: kParts of them, of kWidth lanes each. kCount: a power of two.
template <size_t kCount>
struct GroupShape {
  static constexpr size_t kWidth = std::min(kCount, kLanes), kParts = kCount / kWidth;
  using FloatTag = hn::CappedTag<float, kWidth>;
  using UIntTag = hn::Rebind<uint32_t, FloatTag>;
};

// Groups of masks, floats and 32-bit integers of the same count: masks of comparisons fit all of them.
template <size_t kCount>
struct MaskGroup {
  using Shape = GroupShape<kCount>;
  hn::Mask<typename Shape::FloatTag> part[Shape::kParts];
};
template <size_t kCount>
struct FloatGroup {
  using Shape = GroupShape<kCount>;
  hn::Vec<typename Shape::FloatTag> part[Shape::kParts];
  FloatGroup() = default;
  WAVECREST_INLINE FloatGroup(float x) {
    for (auto& p : part) p = hn::Set(typename Shape::FloatTag(), x);
  }
};
template <size_t kCount>
struct UIntGroup {
  using Shape = GroupShape<kCount>;
  hn::Vec<typename Shape::UIntTag> part[Shape::kParts];
};

// Functions of two groups, value by value.
#define WAVECREST_GROUP_OPERATION(NAME, RESULT, OPERAND, HIGHWAY)                                        \
  template <size_t kCount>                                                                               \
  WAVECREST_INLINE RESULT<kCount> NAME(OPERAND<kCount> a, OPERAND<kCount> b) {                           \
    RESULT<kCount> out;                                                                                  \
    for (size_t i = 0; i < GroupShape<kCount>::kParts; ++i) out.part[i] = HIGHWAY(a.part[i], b.part[i]); \
    return out;                                                                                          \
  }
WAVECREST_GROUP_OPERATION(operator+, FloatGroup, FloatGroup, hn::Add)
WAVECREST_GROUP_OPERATION(operator-, FloatGroup, FloatGroup, hn::Sub)
WAVECREST_GROUP_OPERATION(operator*, FloatGroup, FloatGroup, hn::Mul)
WAVECREST_GROUP_OPERATION(operator/, FloatGroup, FloatGroup, hn::Div)
WAVECREST_GROUP_OPERATION(min, FloatGroup, FloatGroup, hn::Min)
WAVECREST_GROUP_OPERATION(max, FloatGroup, FloatGroup, hn::Max)
WAVECREST_GROUP_OPERATION(copySign, FloatGroup, FloatGroup, hn::CopySign)
WAVECREST_GROUP_OPERATION(operator<=, MaskGroup, FloatGroup, hn::Le)
WAVECREST_GROUP_OPERATION(operator>=, MaskGroup, FloatGroup, hn::Ge)
WAVECREST_GROUP_OPERATION(operator<, MaskGroup, FloatGroup, hn::Lt)
WAVECREST_GROUP_OPERATION(operator>, MaskGroup, FloatGroup, hn::Gt)
WAVECREST_GROUP_OPERATION(operator==, MaskGroup, FloatGroup, hn::Eq)
WAVECREST_GROUP_OPERATION(operator&, MaskGroup, MaskGroup, hn::And)
WAVECREST_GROUP_OPERATION(operator|, MaskGroup, MaskGroup, hn::Or)
#undef WAVECREST_GROUP_OPERATION

template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> operator-(FloatGroup<kCount> a) {
  for (auto& p : a.part) p = hn::Neg(p);
  return a;
}
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> abs(FloatGroup<kCount> a) {
  for (auto& p : a.part) p = hn::Abs(p);
  return a;
}
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> sqrt(FloatGroup<kCount> a) {
  for (auto& p : a.part) p = hn::Sqrt(p);
  return a;
}
// a * b + c, with one rounding where the instruction set has it
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> mulAdd(FloatGroup<kCount> a, FloatGroup<kCount> b, FloatGroup<kCount> c) {
  for (size_t i = 0; i < GroupShape<kCount>::kParts; ++i) c.part[i] = hn::MulAdd(a.part[i], b.part[i], c.part[i]);
  return c;
}
// a * b - c
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> mulSub(FloatGroup<kCount> a, FloatGroup<kCount> b, FloatGroup<kCount> c) {
  for (size_t i = 0; i < GroupShape<kCount>::kParts; ++i) c.part[i] = hn::MulSub(a.part[i], b.part[i], c.part[i]);
  return c;
}
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> select(MaskGroup<kCount> m, FloatGroup<kCount> yes, FloatGroup<kCount> no) {
  for (size_t i = 0; i < GroupShape<kCount>::kParts; ++i) {
    no.part[i] = hn::IfThenElse(m.part[i], yes.part[i], no.part[i]);
  }
  return no;
}
// Each value against the same number.
template <size_t kCount>
WAVECREST_INLINE MaskGroup<kCount> operator!=(UIntGroup<kCount> a, uint32_t b) {
  using Shape = GroupShape<kCount>;
  MaskGroup<kCount> out;
  for (size_t i = 0; i < Shape::kParts; ++i) {
    out.part[i] = hn::RebindMask(typename Shape::FloatTag(), hn::Ne(a.part[i], hn::Set(typename Shape::UIntTag(), b)));
  }
  return out;
}
template <size_t kCount>
WAVECREST_INLINE bool any(MaskGroup<kCount> m) {
  for (const auto& p : m.part) {
    if (!hn::AllFalse(typename GroupShape<kCount>::FloatTag(), p)) return true;
  }
  return false;
}
template <size_t kCount>
WAVECREST_INLINE size_t countTrue(MaskGroup<kCount> m) {
  size_t count = 0;
  for (const auto& p : m.part) count += hn::CountTrue(typename GroupShape<kCount>::FloatTag(), p);
  return count;
}

// ---- memory ---------------------------------------------------------------------------------------------------------

// p is a multiple of the group's size, up to that of a register.
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> loadGroup(const float* p) {
  using Shape = GroupShape<kCount>;
  FloatGroup<kCount> out;
  for (size_t i = 0; i < Shape::kParts; ++i) out.part[i] = hn::Load(typename Shape::FloatTag(), p + i * Shape::kWidth);
  return out;
}
template <size_t kCount>
WAVECREST_INLINE UIntGroup<kCount> loadGroup(const uint32_t* p) {
  using Shape = GroupShape<kCount>;
  UIntGroup<kCount> out;
  for (size_t i = 0; i < Shape::kParts; ++i) out.part[i] = hn::Load(typename Shape::UIntTag(), p + i * Shape::kWidth);
  return out;
}
// Bytes as numbers 0 to 255; p of any alignment.
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount> loadBytes(const uint8_t* p) {
  using Shape = GroupShape<kCount>;
  const typename Shape::FloatTag floats;
  const hn::Rebind<int32_t, decltype(floats)> ints;
  const hn::Rebind<uint8_t, decltype(floats)> bytes;
  FloatGroup<kCount> out;
  for (size_t i = 0; i < Shape::kParts; ++i) {
    out.part[i] = hn::ConvertTo(floats, hn::PromoteTo(ints, hn::LoadU(bytes, p + i * Shape::kWidth)));
  }
  return out;
}
// The four numbers from p on, again and again: an operation on three axes at once. p: of any alignment.
using FourGroup = FloatGroup<std::max<size_t>(4, kLanes)>;
WAVECREST_INLINE FourGroup repeatFour(const float* p) {
  using Shape = FourGroup::Shape;
  FourGroup out;
  for (size_t i = 0; i < Shape::kParts; ++i) {
    out.part[i] = hn::LoadDup128(Shape::FloatTag(), p + i * Shape::kWidth % 4);
  }
  return out;
}
// The one at place kAt in all values. kCount: at least the lanes of a register.
template <size_t kCount, size_t kAt>
WAVECREST_INLINE FloatGroup<kCount> spread(FourGroup a) {
  constexpr bool kWhole = FourGroup::Shape::kParts == 1;  // one register holds all four
  constexpr size_t kPart = kWhole ? 0 : kAt, kLane = kWhole ? kAt : 0;
  FloatGroup<kCount> out;
  for (auto& p : out.part) p = hn::Broadcast<kLane>(a.part[kPart]);
  return out;
}
template <size_t kCount>
WAVECREST_INLINE void store(FloatGroup<kCount> a, float* p) {
  using Shape = GroupShape<kCount>;
  for (size_t i = 0; i < Shape::kParts; ++i) hn::Store(a.part[i], typename Shape::FloatTag(), p + i * Shape::kWidth);
}

// ---- parts ----------------------------------------------------------------------------------------------------------

template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount / 2> firstHalf(FloatGroup<kCount> a) {
  constexpr size_t kParts = GroupShape<kCount>::kParts;
  FloatGroup<kCount / 2> out;
  if constexpr (kParts > 1) {
    std::copy_n(a.part, kParts / 2, out.part);
  } else {
    out.part[0] = hn::LowerHalf(a.part[0]);
  }
  return out;
}
template <size_t kCount>
WAVECREST_INLINE FloatGroup<kCount / 2> secondHalf(FloatGroup<kCount> a) {
  constexpr size_t kParts = GroupShape<kCount>::kParts;
  FloatGroup<kCount / 2> out;
  if constexpr (kParts > 1) {
    std::copy_n(a.part + kParts / 2, kParts / 2, out.part);
  }
#if HWY_TARGET != HWY_SCALAR  // whose registers have no halves
  else {
    out.part[0] = hn::UpperHalf(typename GroupShape<kCount / 2>::FloatTag(), a.part[0]);
  }
#endif
  return out;
}

// ---- across the values ----------------------------------------------------------------------------------------------

// The least value and where it first stands.
struct Least {
  float value;
  size_t index;
};
template <size_t kCount>
WAVECREST_INLINE Least leastOf(FloatGroup<kCount> a) {
  using Shape = GroupShape<kCount>;
  const typename Shape::FloatTag tag;
  if constexpr (Shape::kParts == 1) {
    const auto least = hn::MinOfLanes(tag, a.part[0]);
    return {hn::GetLane(least), hn::FindKnownFirstTrue(tag, hn::Eq(a.part[0], least))};
  } else {
    // The group takes several registers.
    HWY_ALIGN float values[kCount];
    store(a, values);
    const size_t index = static_cast<size_t>(std::min_element(values, values + kCount) - values);
    return {values[index], index};
  }
}

// Appends the items where m holds; returns how many. Writes kCount items, whatever their number.
template <size_t kCount>
WAVECREST_INLINE size_t appendWhere(MaskGroup<kCount> m, UIntGroup<kCount> items, uint32_t* out) {
  using Shape = GroupShape<kCount>;
  const typename Shape::UIntTag tag;
  size_t count = 0;
  for (size_t i = 0; i < Shape::kParts; ++i) {
    // The next register overwrites what this one writes behind its items.
    hn::StoreU(moveToFront(tag, items.part[i], hn::RebindMask(tag, m.part[i])), tag, out + count);
    count += hn::CountTrue(typename Shape::FloatTag(), m.part[i]);
  }
  return count;
}

// The same for eight items in order of falling keys, so that the least is last. Keys are not negative, so their bits
// are in the order of their values. The lowest three bits are ignored, and equal keys come in order of place.
WAVECREST_INLINE size_t appendByFallingKey(MaskGroup<8> m, FloatGroup<8> keys, UIntGroup<8> items, uint32_t* out) {
  using Shape = GroupShape<8>;
  const typename Shape::UIntTag tag;
  constexpr uint32_t kKeyBits = 0x7ffffff8u, kAbsent = 0xffffffffu;
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_SSE4
  static_assert(Shape::kParts == 1);
  // Bitonic sort of the complemented keys, each with its place in the low bits; what is absent goes to the end.
  const auto place = hn::Load(tag, kLaneNumbers);
  const auto sortable = hn::Or(hn::AndNot(hn::BitCast(tag, keys.part[0]), hn::Set(tag, kKeyBits)), place);
  auto v = hn::IfThenElse(hn::RebindMask(tag, m.part[0]), sortable, hn::Set(tag, kAbsent));
  // Keeps the greater of each pair (v, w) in the lanes where `upper` holds.
  const auto exchange = [&](auto w, auto upper)
                            WAVECREST_LAMBDA { v = hn::IfThenElse(upper, hn::Max(v, w), hn::Min(v, w)); };
  const auto laneHasBit = [&](uint32_t bit) WAVECREST_LAMBDA { return hn::TestBit(place, hn::Set(tag, bit)); };
  const auto odd = laneHasBit(1), upperPair = laneHasBit(2), upperHalf = laneHasBit(4);
  // Runs of two, four and eight values are sorted one after the other. The first exchange for a run compares each value
  // with its mirror image in the run.
  exchange(hn::Shuffle2301(v), odd);
  exchange(hn::Shuffle0123(v), upperPair);
  exchange(hn::Shuffle2301(v), odd);
  exchange(hn::Reverse(tag, v), upperHalf);
  exchange(hn::Shuffle1032(v), upperPair);
  exchange(hn::Shuffle2301(v), odd);
  const auto order = hn::IndicesFromVec(tag, hn::And(v, hn::Set(tag, 7u)));
  hn::StoreU(hn::TableLookupLanes(items.part[0], order), tag, out);
  return hn::CountTrue(typename Shape::FloatTag(), m.part[0]);
#else
  HWY_ALIGN uint32_t sortable[8], all[8];
  uint64_t present[8];
  size_t count = 0;
  for (size_t i = 0; i < Shape::kParts; ++i) {
    const auto bits = hn::BitCast(tag, keys.part[i]);
    const auto key = hn::AndNot(bits, hn::Set(tag, kKeyBits));
    const auto known = hn::RebindMask(tag, m.part[i]);
    hn::Store(hn::IfThenElse(known, key, hn::Set(tag, kAbsent)), tag, sortable + i * Shape::kWidth);
    hn::Store(items.part[i], tag, all + i * Shape::kWidth);
  }
  // Insertion sort of the items that are present. An entry is the complemented key with the place in its low bits,
  // above the item.
  for (uint32_t i = 0; i < 8; ++i) {
    if (sortable[i] == kAbsent) continue;
    const uint64_t entry = (uint64_t{sortable[i] | i} << 32) | all[i];
    size_t at = count++;
    for (; at > 0 && present[at - 1] > entry; --at) present[at] = present[at - 1];
    present[at] = entry;
  }
  for (size_t i = 0; i < count; ++i) out[i] = static_cast<uint32_t>(present[i]);
  return count;
#endif
}

WAVECREST_SIMD_END
