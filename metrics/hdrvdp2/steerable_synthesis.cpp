// SteerablePyramid::reconstruct. The pyramid's filters are nearly self-inverting: each band goes through the adjoint of
// the filter that made it, and the coarser levels are spread out with zeros and smoothed by the low-pass filter.
#include "metrics/hdrvdp2/correlation.h"
#include "metrics/hdrvdp2/steerable_pyramid.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::vdp {
namespace {

// What a plane of a band looks like beyond the image's edge. A mirrored image turns one orientation into another: its
// band there is the mirrored band of `partner`, times the sign.
struct Continuation {
  const Plane* partner;
  float xSign, ySign;
};

// Orientations 1 and 3 stay themselves, 2 and 4 change places; reversing x negates 1, reversing y all but 1.
Continuation continuationOf(const Band& band, size_t orientation) {
  if (orientation == 0) return {&band.planes[0], -1, 1};
  if (orientation == 2) return {&band.planes[2], 1, -1};
  return {&band.planes[4 - orientation], 1, -1};
}

// Adds the correlation of a plane with a kernel to the target.
template <size_t kSize>
void addFiltered(Isa isa, const Plane& plane, const Continuation& beyond, const std::array<float, kSize * kSize>& taps,
                 Plane& target) {
  constexpr size_t kReach = kSize / 2;
  const size_t width = plane.width(), height = plane.height();
  Plane extended(width + 2 * kReach, height + 2 * kReach);
  for (size_t row = 0; row < extended.height(); ++row) {
    for (size_t column = 0; column < extended.width(); ++column) {
      const size_t y = mirroredIndex(static_cast<std::ptrdiff_t>(row) - std::ptrdiff_t{kReach}, height);
      const size_t x = mirroredIndex(static_cast<std::ptrdiff_t>(column) - std::ptrdiff_t{kReach}, width);
      const bool yMirrored = y + kReach != row, xMirrored = x + kReach != column;
      // Both reversals together are a half turn: the partner of the partner is the plane itself.
      const Plane& source = xMirrored != yMirrored ? *beyond.partner : plane;
      const float sign = (xMirrored ? beyond.xSign : 1) * (yMirrored ? beyond.ySign : 1);
      extended.row(row)[column] = sign * source.row(y)[x];
    }
  }
  const auto kernel = metricKernels(isa).weightedSum;
  forEachRow(height, [&](size_t y) {
    thread_local AlignedArray<float> buffer;
    if (buffer.size() < roundUpToLanes(width)) buffer = AlignedArray<float>(roundUpToLanes(width));
    std::array<const float*, kSize * kSize> sources{};
    for (size_t i = 0; i < sources.size(); ++i) sources[i] = extended.row(y + i / kSize) + i % kSize;
    const float* weights = taps.data();
    float* row = buffer.data();
    kernel({sources.data(), sources.size(), &weights, 1, &row, width});
    for (size_t x = 0; x < width; ++x) target.row(y)[x] += row[x];
  });
}

Plane spreadOut(const Plane& coarse, Size size) {
  Plane fine(size.width, size.height);
  for (size_t y = 0; y < coarse.height(); ++y)
    for (size_t x = 0; x < coarse.width(); ++x) fine.row(2 * y)[2 * x] = coarse.row(y)[x];
  return fine;
}

}  // namespace

Plane SteerablePyramid::reconstruct(const std::vector<Band>& bands) const {
  static const auto highPass = turned(steerable::kHighPass);
  static const auto firstLowPass = turned(steerable::kFirstLowPass);
  static const auto lowPass = turned(steerable::kLowPass);
  static const std::array bandTaps{turned(steerable::kBands[0]), turned(steerable::kBands[1]),
                                   turned(steerable::kBands[2]), turned(steerable::kBands[3])};
  const auto even = [](const Plane& plane) { return Continuation{&plane, 1, 1}; };
  const Plane& base = bands.back().planes[0];
  Plane sum(base.width(), base.height());
  for (size_t y = 0; y < base.height(); ++y) std::copy_n(base.row(y), base.width(), sum.row(y));
  for (size_t level = levels_; level > 0; --level) {
    const Size size = bandSizes_[level];
    const Plane spread = spreadOut(sum, size);
    Plane finer(size.width, size.height);
    addFiltered<steerable::kLowPassSize>(isa_, spread, even(spread), lowPass, finer);
    for (size_t o = 0; o < steerable::kOrientations; ++o) {
      const Continuation beyond = continuationOf(bands[level], o);
      addFiltered<steerable::kBandSize>(isa_, bands[level].planes[o], beyond, bandTaps[o], finer);
    }
    sum = std::move(finer);
  }
  Plane result(bandSizes_.front().width, bandSizes_.front().height);
  const Plane& residual = bands.front().planes[0];
  addFiltered<steerable::kFirstLowPassSize>(isa_, sum, even(sum), firstLowPass, result);
  addFiltered<steerable::kHighPassSize>(isa_, residual, even(residual), highPass, result);
  return result;
}

}  // namespace wavecrest::vdp
