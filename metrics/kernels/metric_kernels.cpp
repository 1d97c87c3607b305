#include "metrics/kernels/metric_kernels.h"

#include <stdexcept>
#include <string>

#include "compiled_isas.h"

namespace wavecrest {

// Defined by metrics/kernels/table.cpp, once per compiled instruction set.
#define WAVECREST_DECLARE_TABLE(NAMESPACE)  \
  namespace NAMESPACE {                     \
  const MetricKernels& metricKernelTable(); \
  }
WAVECREST_DECLARE_TABLE(N_SCALAR)
WAVECREST_DECLARE_TABLE(N_SSE4)
WAVECREST_DECLARE_TABLE(N_AVX2)
WAVECREST_DECLARE_TABLE(N_AVX3)
#undef WAVECREST_DECLARE_TABLE

const MetricKernels& metricKernels(Isa isa) {
  switch (isa) {
#ifdef WAVECREST_ISA_SCALAR
    case Isa::scalar:
      return N_SCALAR::metricKernelTable();
#endif
#ifdef WAVECREST_ISA_SSE4
    case Isa::sse4:
      return N_SSE4::metricKernelTable();
#endif
#ifdef WAVECREST_ISA_AVX2
    case Isa::avx2:
      return N_AVX2::metricKernelTable();
#endif
#ifdef WAVECREST_ISA_AVX512
    case Isa::avx512:
      return N_AVX3::metricKernelTable();
#endif
    default:
      throw std::invalid_argument("no metric kernels were compiled for " + std::string(toString(isa)));
  }
}

}  // namespace wavecrest
