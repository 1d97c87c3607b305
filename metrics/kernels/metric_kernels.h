// The SIMD kernels of the metrics, and how one instruction set's copy of them is chosen at run time.
//
// Each source of this folder is compiled once per instruction set; table.cpp of each compilation fills one
// MetricKernels. Kernels work on rows of floats that follow the padding rule of metrics/plane.h. They know nothing of
// images, threads or allocation. Rows may be processed beyond their width, up to the next multiple of 16: callers
// provide the room.
#pragma once

#include "kernels/simd/isa.h"
#include "metrics/kernels/ssim_row.h"

namespace wavecrest {

struct MetricKernels {
  std::array<double, 3> (*ssimRow)(const SsimRow& row);
};

// The kernels of one of availableIsas().
const MetricKernels& metricKernels(Isa isa);

}  // namespace wavecrest
