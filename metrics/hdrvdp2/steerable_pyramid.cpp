#include "metrics/hdrvdp2/steerable_pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest::vdp {
namespace {

constexpr size_t kSmallestLevel = 17;

// Reflection about the edge sample, which is not repeated.
size_t mirrored(std::ptrdiff_t index, size_t length) {
  const auto last = static_cast<std::ptrdiff_t>(length) - 1;
  if (index < 0) index = -index;
  if (index > last) index = 2 * last - index;
  return static_cast<size_t>(index);
}

void mirrorBorders(Plane& plane, size_t y) {
  float* row = plane.row(y);
  const auto width = static_cast<std::ptrdiff_t>(plane.width());
  for (std::ptrdiff_t i = 1; i <= static_cast<std::ptrdiff_t>(SteerablePyramid::kInputBorder); ++i) {
    row[-i] = row[mirrored(-i, plane.width())];
    row[width - 1 + i] = row[mirrored(width - 1 + i, plane.width())];
  }
}

template <size_t kCount>
std::array<float, kCount> toFloat(const std::array<double, kCount>& taps) {
  std::array<float, kCount> result{};
  std::transform(taps.begin(), taps.end(), result.begin(), [](double t) { return static_cast<float>(t); });
  return result;
}

// The pointers that make row y of a correlation with a size x size kernel: one for each tap.
template <size_t kSize>
std::array<const float*, kSize * kSize> tapRows(const Plane& in, size_t y) {
  constexpr auto kCentre = static_cast<std::ptrdiff_t>(kSize / 2);
  std::array<const float*, kSize * kSize> rows{};
  for (size_t i = 0; i < kSize; ++i) {
    const float* row = in.row(mirrored(static_cast<std::ptrdiff_t>(y + i) - kCentre, in.height())) - kCentre;
    for (size_t j = 0; j < kSize; ++j) rows[i * kSize + j] = row + j;
  }
  return rows;
}

template <class Function>
void forEachRow(size_t rows, Function function) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, rows, 4), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t y = range.begin(); y < range.end(); ++y) function(y);
  });
}

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

// Low-pass filter and subsampling in one: taps on even columns read the plane of even columns, and so on, so that
// neighbouring outputs read neighbouring samples.
void SteerablePyramid::subsample(const Plane& even, const Plane& odd, size_t inputHeight, Plane& out) const {
  static const auto taps = toFloat(steerable::kLowPass);
  constexpr size_t kSize = steerable::kLowPassSize;
  constexpr auto kCentre = static_cast<std::ptrdiff_t>(kSize / 2);
  const auto kernel = metricKernels(isa_).weightedSum;
  forEachRow(out.height(), [&](size_t y) {
    std::array<const float*, kSize * kSize> sources{};
    for (size_t i = 0; i < kSize; ++i) {
      const size_t row = mirrored(static_cast<std::ptrdiff_t>(2 * y + i) - kCentre, inputHeight);
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
  forEachRow(input.height(), [&](size_t y) { mirrorBorders(input, y); });
  // Without levels the first low-pass is the base itself.
  filterInput(input, bands[0].planes[0], levels_ > 0 ? workspace.lowPass[0] : bands.back().planes[0]);
  for (size_t level = 0; level < levels_; ++level) {
    Plane& in = workspace.lowPass[level];
    Plane& even = workspace.even[level];
    Plane& odd = workspace.odd[level];
    forEachRow(in.height(), [&](size_t y) {
      mirrorBorders(in, y);
      constexpr auto kHalfBorder = static_cast<std::ptrdiff_t>(kInputBorder / 2);
      const float* row = in.row(y);
      float *evenRow = even.row(y), *oddRow = odd.row(y);
      for (std::ptrdiff_t x = -kHalfBorder; x < static_cast<std::ptrdiff_t>(even.width()) + kHalfBorder; ++x) {
        evenRow[x] = row[2 * x];
        oddRow[x] = row[2 * x + 1];
      }
    });
    filterLevel(in, bands[level + 1]);
    subsample(even, odd, in.height(), level + 1 < levels_ ? workspace.lowPass[level + 1] : bands.back().planes[0]);
  }
}

}  // namespace wavecrest::vdp
