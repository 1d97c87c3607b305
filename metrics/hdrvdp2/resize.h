// Bicubic resampling along one axis as HDR-VDP-2 uses it between the levels of its pyramid.
//
// The kernel is Keys' cubic (a = -1/2), widened when shrinking, without normalising the weights, edges mirrored with
// the edge sample repeated. Weights depend on the two lengths only, so they are tabulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wavecrest::vdp {

// Output sample i is the sum over taps of weight * in[index]. All outputs have the same number of taps; unused ones
// weigh nothing. Both orders are kept: by output for columns, by tap for rows.
struct ResizeTable {
  ResizeTable(size_t inputs, size_t outputs);

  size_t taps = 0, stride = 0;  // stride: outputs rounded up to whole vectors
  std::vector<uint32_t> indexByOutput, indexByTap;
  std::vector<float> weightByOutput, weightByTap;
};

}  // namespace wavecrest::vdp
