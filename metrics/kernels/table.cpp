// The table of one instruction set's kernels. Compiled once per instruction set, like the kernels.
#include "kernels/simd/lanes.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::WAVECREST_SIMD_NAMESPACE {

#define WAVECREST_DECLARE_KERNEL(RETURN, NAME, PARAMETERS) RETURN NAME PARAMETERS;
WAVECREST_METRIC_KERNELS(WAVECREST_DECLARE_KERNEL)
#undef WAVECREST_DECLARE_KERNEL

const MetricKernels& metricKernelTable() {
#define WAVECREST_LIST_KERNEL(RETURN, NAME, PARAMETERS) .NAME = NAME,
  static constexpr MetricKernels table{WAVECREST_METRIC_KERNELS(WAVECREST_LIST_KERNEL)};
#undef WAVECREST_LIST_KERNEL
  return table;
}

}  // namespace wavecrest::WAVECREST_SIMD_NAMESPACE
