// Groups behind plain pointers, for group_test.cpp.
#include "tests/kernels/group_entries.h"

#include "kernels/simd/group.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

WAVECREST_INLINE MaskGroup<8> maskOf(const uint32_t* present) { return loadGroup<8>(present) != 0; }

constexpr GroupEntries kGroupEntries = {
    .appendWhere = [](const uint32_t* present, const uint32_t* items, uint32_t* out)
                       HWY_ATTR -> size_t { return appendWhere(maskOf(present), loadGroup<8>(items), out); },
    .appendByFallingKey = [](const uint32_t* present, const float* keys, const uint32_t* items, uint32_t* out)
                              HWY_ATTR -> size_t {
      return appendByFallingKey(maskOf(present), loadGroup<8>(keys), loadGroup<8>(items), out);
    },
    .leastOf = [](const float* values, float* least) HWY_ATTR -> size_t {
      const Least found = leastOf(loadGroup<4>(values));
      *least = found.value;
      return found.index;
    },
    .loadBytes = [](const uint8_t* bytes, float* out) HWY_ATTR { store(loadBytes<8>(bytes), out); }};
WAVECREST_REGISTER_ENTRIES(GroupEntries, kGroupEntries);

}  // namespace
WAVECREST_SIMD_END
