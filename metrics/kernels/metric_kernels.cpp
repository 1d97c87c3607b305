#include "metrics/kernels/metric_kernels.h"

#include <stdexcept>

// The namespaces are Highway's names of its targets; the build says which of them hold a copy.
#define WAVECREST_DECLARE_TABLE(TARGET)     \
  namespace wavecrest::TARGET {             \
  const MetricKernels& metricKernelTable(); \
  }
#ifdef WAVECREST_HAS_scalar
WAVECREST_DECLARE_TABLE(N_SCALAR)
#endif
#ifdef WAVECREST_HAS_sse4
WAVECREST_DECLARE_TABLE(N_SSE4)
#endif
#ifdef WAVECREST_HAS_avx2
WAVECREST_DECLARE_TABLE(N_AVX2)
#endif
#ifdef WAVECREST_HAS_avx512
WAVECREST_DECLARE_TABLE(N_AVX3)
#endif

namespace wavecrest {

const MetricKernels& metricKernels(Isa isa) {
  switch (isa) {
#ifdef WAVECREST_HAS_scalar
    case Isa::scalar:
      return N_SCALAR::metricKernelTable();
#endif
#ifdef WAVECREST_HAS_sse4
    case Isa::sse4:
      return N_SSE4::metricKernelTable();
#endif
#ifdef WAVECREST_HAS_avx2
    case Isa::avx2:
      return N_AVX2::metricKernelTable();
#endif
#ifdef WAVECREST_HAS_avx512
    case Isa::avx512:
      return N_AVX3::metricKernelTable();
#endif
    default:
      throw std::logic_error("the metrics were not compiled for this instruction set");
  }
}

}  // namespace wavecrest
