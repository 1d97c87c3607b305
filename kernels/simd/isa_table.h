// IsaTable: one set of entry points per instruction set, filled by the lane sources and read by plain code.
//
// A lane source is compiled once per instruction set; each compilation registers its own entries before main. Used
// where a set of kernels has one user: tests and microbenchmarks. Link the objects of such a source directly (see
// add_lane_executable in cmake/kernel_library.cmake): a linker may leave registrations in a static library behind.
#pragma once

#include <array>
#include <cassert>

#include "kernels/simd/isa.h"

namespace wavecrest {

// Entries is a plain struct of function pointers and facts.
template <class Entries>
class IsaTable {
 public:
  static bool add(Isa isa, const Entries& entries) {
    table_[static_cast<size_t>(isa)] = &entries;
    return true;
  }
  // isa must be one of availableIsas().
  static const Entries& of(Isa isa) {
    const Entries* entries = table_[static_cast<size_t>(isa)];
    assert(entries != nullptr);
    return *entries;
  }

 private:
  static inline constinit std::array<const Entries*, kAllIsas.size()> table_{};
};

}  // namespace wavecrest

// In a lane source, inside WAVECREST_SIMD_BEGIN/END: registers a constant of type Entries for this compilation.
#define WAVECREST_REGISTER_ENTRIES(ENTRIES_TYPE, CONSTANT) \
  [[maybe_unused]] const bool registered##ENTRIES_TYPE = IsaTable<ENTRIES_TYPE>::add(kIsa, CONSTANT)
