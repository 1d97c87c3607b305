// Entry points of mis_entries.cpp: the steps of the MIS recursion (kernels/mis_lanes.h) on columns, in float and
// double.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/stages.h"

namespace wavecrest {

template <class S>
struct MisColumns {
  S *dVCM, *dVC;
};

// Columns are padded to the lane count; the sums are read and written in place.
template <class S>
struct MisKernels {
  void (*scatter)(const MisSettings& settings, Walk walk, uint32_t depth, size_t count, const S* pdf,
                  const S* pdfReverse, const S* woCosine, const MisColumns<S>& sums);
  void (*scatterSpecular)(size_t count, const S* jacobian, const MisColumns<S>& sums);
  void (*behindConnection)(const MisSettings& settings, Walk walk, uint32_t depth, size_t count,
                           const MisColumns<S>& sums, const S* pdfReverse, S* out);
  void (*behindLens)(const MisSettings& settings, uint32_t depth, size_t count, const MisColumns<S>& sums,
                     const S* pdfReverse, S* out);
  void (*behindMerge)(const MisSettings& settings, size_t count, const MisColumns<S>& sums, const S* pdf, S* out);
};

struct MisEntries {
  size_t lanes;
  MisKernels<float> floating;
  MisKernels<double> doubled;
};

}  // namespace wavecrest
