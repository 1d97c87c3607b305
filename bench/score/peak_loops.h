// The loops of peak_lanes.cpp, compiled once per instruction set.
#pragma once

#include <cstddef>

#include "kernels/simd/isa.h"

namespace wavecrest {

struct PeakLoops {
  size_t lanes = 0;
  size_t operationsPerRound = 0;  // additions and multiplications of multiplyAdd
  // out[i] = a[i] + factor b[i]; aligned columns, count a multiple of the lanes.
  void (*triad)(const float* a, const float* b, float factor, float* out, size_t count) = nullptr;
  // factor below 1, or the sums overflow. The result only proves that they were computed.
  float (*multiplyAdd)(float factor, size_t rounds) = nullptr;
};

// Of one of availableIsas().
const PeakLoops& peakLoopsOf(Isa isa);

}  // namespace wavecrest
