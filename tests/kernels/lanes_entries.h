// Entry points of lanes_entries.cpp: each operation of kernels/simd on exactly one block of lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace wavecrest {

// out[i] = operation(a[i], b[i], c[i]) for i < lanes. Unaligned pointers; comparisons give 1 and 0.
template <class T>
struct LaneOperation {
  const char* name;
  void (*run)(const T* a, const T* b, const T* c, T* out);
};

struct LanesEntries {
  const char* target;  // the namespace of the compilation, N_AVX3 and so on
  int64_t targetBit;   // HWY_TARGET: the instruction set that Highway compiled for
  size_t lanes;
  std::span<const LaneOperation<float>> floatOperations;
  std::span<const LaneOperation<double>> doubleOperations;
  std::span<const LaneOperation<uint32_t>> uintOperations;
  // Conversions between lane types.
  void (*floatToUInt)(const float* in, uint32_t* out);
  void (*uintToFloat)(const uint32_t* in, float* out);
  void (*floatToDouble)(const float* in, double* out);
  void (*doubleToFloat)(const double* in, float* out);
  void (*doubleToLong)(const double* in, int64_t* out);  // storeTruncated
  // Memory. flags[i] != 0 makes the mask; compress returns how many lanes it kept.
  void (*gather)(const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index,
                 float* floatsOut, double* doublesOut, uint32_t* uintsOut);
  // Four columns, one after the other; by indices in a vector, and in memory.
  void (*gatherFour)(const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index,
                     float* floatsOut, double* doublesOut, uint32_t* uintsOut);
  void (*loadFour)(const float* floats, const double* doubles, const uint32_t* uints, const uint32_t* index,
                   float* floatsOut, double* doublesOut, uint32_t* uintsOut);
  // Sixteen columns of kLanes numbers, one after the other, as records.
  void (*storeRecords)(const float* floats, const double* doubles, bool stream, float* floatsOut, double* doublesOut);
  size_t (*compress)(const uint32_t* flags, const float* floats, const double* doubles, const uint32_t* uints,
                     float* floatsOut, double* doublesOut, uint32_t* uintsOut);
  // Lanes in the given order, and in that which splits them; `rest` as flags.
  void (*inOrder)(const uint32_t* order, const float* floats, const double* doubles, const uint32_t* uints,
                  float* floatsOut, double* doublesOut, uint32_t* uintsOut);
  void (*splitOrder)(const uint32_t* flags, const uint32_t* rest, uint32_t* out);
  // Masks. Bits of the answer: 1 any, 2 all, 4 none; out gets the mask as 0 and 1.
  uint32_t (*firstLanes)(size_t n, uint32_t* out);
  uint32_t (*maskQueries)(const uint32_t* flags);
  void (*laneIndex)(uint32_t start, uint32_t* out);
};

}  // namespace wavecrest
