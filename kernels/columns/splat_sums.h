// The film's sums of splats: one 128-bit integer for each pixel and channel, in fixed point.
//
// Integers add up to the same total in any order, so an image does not depend on which worker splats first. The unit is
// a power of two that follows from the scene (engine/plan/memory_plan.cpp), far below a typical splat: rounding to it
// is invisible, and a scene that is 2^k times as bright has sums of the same bits. The low halves are what all splats
// go to. The high halves change only when a low one wraps or a splat is very large: after some thousand typical splats
// of one pixel. So speed and cache lines are those of 64-bit sums, and no brightness or length of render overflows.
#pragma once

#include <cstdint>

namespace wavecrest {

struct SplatSums {
  uint64_t* low = nullptr;   // RGB, row by row; both halves together are a number in two's complement
  uint64_t* high = nullptr;  // the same
  double scale = 1;          // units in 1; a power of two
};

// A typical splat has 2^48 units: a splat that is 2^24 times darker still keeps all digits of a float.
constexpr int kSplatUnitBits = 48;

// One splat is at most this many units, and a sum stays within this plus one splat; more is saturated and counted. It
// is 2^76 typical splats.
constexpr double kSplatLimit = 0x1p124;

// Below this a splat is a 63-bit integer that needs no high half of its own.
constexpr double kSmallSplatLimit = 0x1p62;

// Adds a finite value to one channel's sum; scalar, for any size and sign. Returns false where the sum is saturated.
inline bool addToSplatSum(const SplatSums& sums, size_t channel, double value) {
  using Wide = __int128;
  const double scaled = value * sums.scale;
  if (!(scaled < kSplatLimit && scaled > -kSplatLimit)) {
    const Wide limit = static_cast<Wide>(scaled > 0 ? kSplatLimit : -kSplatLimit);
    sums.low[channel] = static_cast<uint64_t>(limit);
    sums.high[channel] = static_cast<uint64_t>(limit >> 64);
    return false;
  }
  const Wide rounded = static_cast<Wide>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  const Wide sum = static_cast<Wide>(static_cast<unsigned __int128>(sums.high[channel]) << 64 | sums.low[channel]);
  const Wide limit = static_cast<Wide>(kSplatLimit);
  if (sum >= limit || sum <= -limit) return false;
  const Wide total = sum + rounded;
  sums.low[channel] = static_cast<uint64_t>(total);
  sums.high[channel] = static_cast<uint64_t>(total >> 64);
  return true;
}

// The sum of one channel, in units.
inline __int128 splatSum(const SplatSums& sums, size_t channel) {
  return static_cast<__int128>(static_cast<unsigned __int128>(sums.high[channel]) << 64 | sums.low[channel]);
}

}  // namespace wavecrest
