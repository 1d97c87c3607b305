// A hash of three indices, for tables of the distinct corners of a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace wavecrest {

struct TripleHash {
  // Mixes all bits, so that no choice of indices can crowd the table (finalizer of splitmix64).
  static uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  size_t operator()(const std::array<uint32_t, 3>& t) const { return mix(mix((uint64_t{t[0]} << 32) + t[1]) + t[2]); }
};

}  // namespace wavecrest
