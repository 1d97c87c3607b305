// The SIMD kernels of the metrics, and how one instruction set's copy of them is chosen at run time.
//
// Each source of this folder is compiled once per instruction set; table.cpp of each compilation fills one
// MetricKernels. Kernels work on rows of floats that follow the padding rule of metrics/planes/plane.h. They know
// nothing of images, threads or allocation. Rows may be processed beyond their width, up to the next multiple of 16:
// callers provide the room.
#pragma once

#include "kernels/simd/isa.h"
#include "metrics/kernels/cvvdp_rows.h"
#include "metrics/kernels/fft_stage.h"
#include "metrics/kernels/flip_rows.h"
#include "metrics/kernels/hdrvdp2_rows.h"
#include "metrics/kernels/pu21_row.h"
#include "metrics/kernels/row_filters.h"
#include "metrics/kernels/ssim_row.h"

// The list of kernels: return type, name, parameters.
#define WAVECREST_METRIC_KERNELS(KERNEL)                                                               \
  KERNEL(void, fftStage, (const FftStage& stage, const float* in, float* out, FftDirection direction)) \
  KERNEL(void, multiplyElements,                                                                       \
         (const float* in, const float* factors, float* out, size_t count, FftDirection direction))    \
  KERNEL(void, multiplyGain, (float* batch, const float* gain, size_t length))                         \
  KERNEL(void, weightedSum, (const WeightedSum& job))                                                  \
  KERNEL(void, gatheredSum, (const GatheredSum& job))                                                  \
  KERNEL(void, photoreceptorRow, (const PhotoreceptorRow& row))                                        \
  KERNEL(void, logMeanRow, (const LogMeanRow& row))                                                    \
  KERNEL(void, sensitivityRow, (const SensitivityRow& row))                                            \
  KERNEL(void, mutualMaskRow, (const MutualMaskRow& row))                                              \
  KERNEL(double, differenceRow, (const DifferenceRow& row))                                            \
  KERNEL(void, cvvdpContrastRow, (const CvvdpContrastRow& row))                                        \
  KERNEL(CvvdpChannels<double>, cvvdpDifferenceRow, (const CvvdpDifferenceRow& row))                   \
  KERNEL(void, pu21Row, (const Pu21Row& row))                                                          \
  KERNEL(void, flipAppearanceRow, (const FlipAppearanceRow& row))                                      \
  KERNEL(void, flipFeatureRow, (const FlipFeatureRow& row))                                            \
  KERNEL(void, flipErrorRow, (const FlipErrorRow& row))                                                \
  KERNEL(SsimSums, ssimRow, (const SsimRow& row))

namespace wavecrest {

struct MetricKernels {
#define WAVECREST_KERNEL_POINTER(RETURN, NAME, PARAMETERS) RETURN(*NAME) PARAMETERS;
  WAVECREST_METRIC_KERNELS(WAVECREST_KERNEL_POINTER)
#undef WAVECREST_KERNEL_POINTER
};

// The kernels of one of availableIsas().
const MetricKernels& metricKernels(Isa isa);

}  // namespace wavecrest
