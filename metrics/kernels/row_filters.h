// Linear filters of rows: every separable or two-dimensional filter of the metrics is a weighted sum of shifted rows.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wavecrest {

constexpr size_t kMaxFilterOutputs = 4;

// out[o][x] = sum over i of weights[o][i] * sources[i][x], 0 <= x < width rounded up to whole vectors.
// The taps of a filter become pointers: a source is an input row, shifted by the tap's column offset.
struct WeightedSum {
  const float* const* sources;
  size_t count;
  const float* const* weights;
  size_t outputs;  // 1 to kMaxFilterOutputs filters that share their sources
  float* const* out;
  size_t width;
};

// out[x] = sum over taps t of weights[t * stride + x] * in[indices[t * stride + x]], for resampling along a row.
// stride and the readable length of both tables are whole vectors.
struct GatheredSum {
  const float* in;
  const uint32_t* indices;
  const float* weights;
  size_t taps, stride;
  float* out;
};

}  // namespace wavecrest
