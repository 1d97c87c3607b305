// The table of one instruction set's kernels. Compiled once per instruction set, like the kernels.
#include "kernels/simd/lanes.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::WAVECREST_SIMD_NAMESPACE {

std::array<double, 3> ssimRow(const SsimRow& row);

const MetricKernels& metricKernelTable() {
  static constexpr MetricKernels table{.ssimRow = ssimRow};
  return table;
}

}  // namespace wavecrest::WAVECREST_SIMD_NAMESPACE
