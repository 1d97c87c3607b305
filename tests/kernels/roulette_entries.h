// Entry points of roulette_entries.cpp: kernels/connect/roulette_lanes.h on columns.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wavecrest {

struct RouletteEntries {
  size_t lanes;
  // The probability of joining a connection that carries so much, where all from `below` on are joined.
  float (*chance)(float carried, float below);
  // Of the 2^24 numbers that a camera vertex may have, how many join a pair at this depth.
  uint64_t (*joined)(float chance, uint32_t depth);
};

}  // namespace wavecrest
