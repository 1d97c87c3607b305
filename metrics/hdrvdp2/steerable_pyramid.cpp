#include "metrics/hdrvdp2/steerable_pyramid.h"

#include <algorithm>

#include "metrics/hdrvdp2/correlation.h"
#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::vdp {
namespace {

// Levels are made while both sides are at least as long as the low-pass kernel.
constexpr size_t kSmallestLevel = 17;

}  // namespace

SteerablePyramid::SteerablePyramid(size_t width, size_t height, Isa isa) : isa_(isa) {
  // The number of levels follows from halved sizes rounded down; the sizes themselves are rounded up.
  for (size_t w = width, h = height; std::min(w, h) >= kSmallestLevel; w /= 2, h /= 2) ++levels_;
  bandSizes_.push_back({width, height});
  for (size_t level = 0; level <= levels_; ++level) {
    bandSizes_.push_back({width, height});
    width = (width + 1) / 2;
    height = (height + 1) / 2;
  }
}

// One plane in the first and the last band, one for each orientation in the others.
std::vector<Band> SteerablePyramid::makeBands() const {
  std::vector<Band> bands(bandSizes_.size());
  for (size_t b = 0; b < bands.size(); ++b) {
    bands[b].orientations = b == 0 || b + 1 == bands.size() ? 1 : steerable::kOrientations;
    for (size_t o = 0; o < bands[b].orientations; ++o)
      bands[b].planes[o] = Plane(bandSizes_[b].width, bandSizes_[b].height);
  }
  return bands;
}

SteerablePyramid::Workspace SteerablePyramid::makeWorkspace() const {
  Workspace workspace;
  for (size_t level = 0; level < levels_; ++level) {
    const auto [width, height] = bandSizes_[level + 1];
    workspace.lowPass.emplace_back(width, height, kInputBorder);
    workspace.even.emplace_back((width + 1) / 2, height, kInputBorder);
    workspace.odd.emplace_back((width + 1) / 2, height, kInputBorder);
  }
  return workspace;
}

// The high-pass residual and the first low-pass of the image, both at full size.
void SteerablePyramid::filterInput(const Plane& input, Plane& highPass, Plane& lowPass) const {
  static const auto highTaps = toFloat(steerable::kHighPass);
  static const auto lowTaps = toFloat(steerable::kFirstLowPass);
  const auto kernel = metricKernels(isa_).weightedSum;
  forEachRow(input.height(), [&](size_t y) {
    const auto filter = [&](const auto& sources, const auto& taps, float* out) {
      const float* weights = taps.data();
      kernel({sources.data(), sources.size(), &weights, 1, &out, input.width()});
    };
    filter(tapRows<steerable::kHighPassSize>(input, y), highTaps, highPass.row(y));
    filter(tapRows<steerable::kFirstLowPassSize>(input, y), lowTaps, lowPass.row(y));
  });
}

// The oriented bands of one level. All four filters share their source rows, so one call of the kernel applies them.
void SteerablePyramid::filterLevel(const Plane& in, Band& band) const {
  static const std::array taps{toFloat(steerable::kBands[0]), toFloat(steerable::kBands[1]),
                               toFloat(steerable::kBands[2]), toFloat(steerable::kBands[3])};
  const auto kernel = metricKernels(isa_).weightedSum;
  forEachRow(in.height(), [&](size_t y) {
    const auto sources = tapRows<steerable::kBandSize>(in, y);
    std::array<const float*, steerable::kOrientations> weights{};
    std::array<float*, steerable::kOrientations> out{};
    for (size_t o = 0; o < weights.size(); ++o) {
      weights[o] = taps[o].data();
      out[o] = band.planes[o].row(y);
    }
    kernel({sources.data(), sources.size(), weights.data(), weights.size(), out.data(), in.width()});
  });
}

// Low-pass filter and subsampling in one. Taps on even columns read the plane of even columns, others that of odd
// columns. So neighbouring outputs read neighbouring samples.
void SteerablePyramid::subsample(const Plane& even, const Plane& odd, size_t inputHeight, Plane& out) const {
  static const auto taps = toFloat(steerable::kLowPass);
  constexpr size_t kSize = steerable::kLowPassSize;
  constexpr auto kCentre = static_cast<std::ptrdiff_t>(kSize / 2);
  const auto kernel = metricKernels(isa_).weightedSum;
  forEachRow(out.height(), [&](size_t y) {
    std::array<const float*, kSize * kSize> sources{};
    for (size_t i = 0; i < kSize; ++i) {
      const size_t row = mirroredIndex(static_cast<std::ptrdiff_t>(2 * y + i) - kCentre, inputHeight);
      for (size_t j = 0; j < kSize; ++j) {
        // Column 2x + j - 8 is column x + (j - 8) / 2 of the even plane, or x + (j - 9) / 2 of the odd one.
        const Plane& half = j % 2 == 0 ? even : odd;
        sources[i * kSize + j] = half.row(row) + (static_cast<std::ptrdiff_t>(j - j % 2) - kCentre) / 2;
      }
    }
    const float* weights = taps.data();
    float* target = out.row(y);
    kernel({sources.data(), sources.size(), &weights, 1, &target, out.width()});
  });
}

void SteerablePyramid::decompose(Plane& input, std::vector<Band>& bands, Workspace& workspace) const {
  // Residual and first low-pass.
  forEachRow(input.height(), [&](size_t y) { mirrorBorders(input, y, kInputBorder); });
  // Without levels the first low-pass is the base itself.
  filterInput(input, bands[0].planes[0], levels_ > 0 ? workspace.lowPass[0] : bands.back().planes[0]);
  for (size_t level = 0; level < levels_; ++level) {
    // Split the low-pass of this level into its even and odd columns, borders included.
    Plane& in = workspace.lowPass[level];
    Plane& even = workspace.even[level];
    Plane& odd = workspace.odd[level];
    forEachRow(in.height(), [&](size_t y) {
      mirrorBorders(in, y, kInputBorder);
      constexpr auto kHalfBorder = static_cast<std::ptrdiff_t>(kInputBorder / 2);
      const float* row = in.row(y);
      float *evenRow = even.row(y), *oddRow = odd.row(y);
      for (std::ptrdiff_t x = -kHalfBorder; x < static_cast<std::ptrdiff_t>(even.width()) + kHalfBorder; ++x) {
        evenRow[x] = row[2 * x];
        oddRow[x] = row[2 * x + 1];
      }
    });
    // The oriented bands of this level, then the low-pass of the next. The last low-pass is the base.
    filterLevel(in, bands[level + 1]);
    subsample(even, odd, in.height(), level + 1 < levels_ ? workspace.lowPass[level + 1] : bands.back().planes[0]);
  }
}

}  // namespace wavecrest::vdp
