// Entry points of warp_entries.cpp: each warp of kernels/sampling/warp_lanes.h on columns, in Float and in Double.
#pragma once

#include <cstddef>

namespace wavecrest {

// Points for the numbers (u[i], v[i]), i < count, a multiple of the lane count. z is 0 for planar warps. height: of the
// cone's cap, 1 - cos of its half angle; of other warps 0.
template <class T>
using Warp = void (*)(const T* u, const T* v, T parameter, T* x, T* y, T* z, T* height, size_t count);

template <class T>
struct WarpFunctions {
  Warp<T> concentricDisc, cosineHemisphere, uniformSphere;
  Warp<T> uniformCone;      // parameter: sin^2 of the half angle
  Warp<T> uniformTriangle;  // the folded square
};

struct WarpEntries {
  size_t lanes;
  WarpFunctions<float> floats;
  WarpFunctions<double> doubles;
};

}  // namespace wavecrest
