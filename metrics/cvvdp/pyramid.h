// The decimated pyramid of ColorVideoVDP: halving and doubling of planes with the filter of Burt and Adelson (1983),
// a = 0.4, row by row.
#pragma once

#include <vector>

#include "metrics/kernels/metric_kernels.h"
#include "metrics/planes/plane.h"

namespace wavecrest::cvvdp {

struct PlaneSize {
  size_t width, height;
};

// Moves planes between a size and half of it, rounded up.
class Halving {
 public:
  explicit Halving(PlaneSize fine);

  PlaneSize coarse() const { return {(fine_.width + 1) / 2, (fine_.height + 1) / 2}; }
  // Floats that the scratch row of either function needs.
  size_t scratchFloats() const { return roundUpToLanes(fine_.width); }

  // Row y of the half size.
  void reduceRow(const MetricKernels& kernels, const Plane& fine, size_t y, float* scratch, float* out) const;
  // Row y of the full size.
  void expandRow(const MetricKernels& kernels, const Plane& coarse, size_t y, float* scratch, float* out) const;

 private:
  // Weights and source columns of each column of a row (GatheredSum).
  struct Columns {
    size_t taps = 0, stride = 0;
    std::vector<uint32_t> indices;
    std::vector<float> weights;

    Columns(size_t tapCount, size_t width);
    void set(size_t tap, size_t column, size_t index, double weight);
    GatheredSum job(const float* in, float* out) const;
  };
  static Columns reducingColumns(PlaneSize fine);
  static Columns expandingColumns(PlaneSize fine);

  PlaneSize fine_;
  Columns reducing_, expanding_;
};

}  // namespace wavecrest::cvvdp
