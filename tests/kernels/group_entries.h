// Entry points of group_entries.cpp: what kernels/simd/group.h does across the values of a group.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wavecrest {

struct GroupEntries {
  // Of eight keys and items those where present[i] is not 0, into out, which has room for sixteen. Return how many.
  size_t (*appendWhere)(const uint32_t* present, const uint32_t* items, uint32_t* out);
  size_t (*appendByFallingKey)(const uint32_t* present, const float* keys, const uint32_t* items, uint32_t* out);
  // The least of four values and its place.
  size_t (*leastOf)(const float* values, float* least);
  // Eight bytes as numbers.
  void (*loadBytes)(const uint8_t* bytes, float* out);
};

}  // namespace wavecrest
