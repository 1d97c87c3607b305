// Roulette of connections: the probability with which a connection is joined, and the number that decides (METHODS
// 5.9).
//
// Probabilities may be far below 1, where numbers of 24 bits are a coarse grid. Both are multiples of 2^-24, so that
// P(number < probability) is the probability to the last bit, however small.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// min(1, carried / below), rounded up to the grid. carried: above 0.
template <class Real>
WAVECREST_INLINE Real rouletteChance(Real carried, Real below) {
  const Real steps = -floor(min(Real(1), carried / below) * Real(-0x1p24f));
  return steps * Real(0x1p-24f);
}

// The number of a pair of vertices from that of its camera vertex: turned by the golden ratio for each depth of the
// light vertex, which spreads those of a camera vertex evenly over the depths. Turning an integer keeps it on the grid.
WAVECREST_INLINE Float rouletteNumber(Float uniform, UInt depth) {
  constexpr uint32_t kGoldenRatio = 10368890;  // (sqrt(5) - 1) / 2 times 2^24
  const UInt turned = toUInt(uniform * Float(0x1p24f)) + depth * UInt(kGoldenRatio);
  return toFloat(turned & UInt(0xffffffu)) * Float(0x1p-24f);
}

WAVECREST_SIMD_END
