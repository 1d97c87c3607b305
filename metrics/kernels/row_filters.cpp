// weightedSum, gatheredSum: see metrics/kernels/row_filters.h for what goes in and out.
// Sums stay in registers over all taps; several vectors of a row run together to hide the latency of multiply-adds.
#include "metrics/kernels/row_filters.h"

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

// kVectors neighbouring vectors of each output, from column x.
template <size_t kOutputs, size_t kVectors>
WAVECREST_INLINE void sumBlock(const WeightedSum& job, size_t x) {
  Float sum[kOutputs][kVectors];
  for (auto& output : sum)
    for (Float& s : output) s = Float(0.0f);
  for (size_t i = 0; i < job.count; ++i) {
    const float* source = job.sources[i] + x;
    Float value[kVectors];
    for (size_t v = 0; v < kVectors; ++v) value[v] = loadUnaligned(source + v * kLanes);
    for (size_t o = 0; o < kOutputs; ++o) {
      const Float weight(job.weights[o][i]);
      for (size_t v = 0; v < kVectors; ++v) sum[o][v] = mulAdd(weight, value[v], sum[o][v]);
    }
  }
  for (size_t o = 0; o < kOutputs; ++o)
    for (size_t v = 0; v < kVectors; ++v) storeUnaligned(sum[o][v], job.out[o] + x + v * kLanes);
}

template <size_t kOutputs, size_t kVectors>
void sumRow(const WeightedSum& job) {
  size_t x = 0;
  for (; x + (kVectors - 1) * kLanes < job.width; x += kVectors * kLanes) sumBlock<kOutputs, kVectors>(job, x);
  for (; x < job.width; x += kLanes) sumBlock<kOutputs, 1>(job, x);
}

}  // namespace

void weightedSum(const WeightedSum& job) {
  switch (job.outputs) {
    case 1:
      return sumRow<1, 4>(job);
    case 2:
      return sumRow<2, 4>(job);
    case 3:
      return sumRow<3, 2>(job);
    default:
      return sumRow<4, 2>(job);
  }
}

void gatheredSum(const GatheredSum& job) {
  for (size_t x = 0; x < job.stride; x += kLanes) {
    Float sum(0.0f);
    for (size_t at = x; at < job.taps * job.stride; at += job.stride) {
      const Float value = gather(job.in, loadUnaligned(job.indices + at));
      sum = mulAdd(loadUnaligned(job.weights + at), value, sum);
    }
    storeUnaligned(sum, job.out + x);
  }
}

WAVECREST_SIMD_END
