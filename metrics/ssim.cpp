#include "metrics/ssim.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace {

constexpr size_t kBandRows = 48;  // rows of one task: its float rows stay in a core's L2

// Weights of the centre and of the offsets 1..5 on either side.
std::array<double, kSsimRadius + 1> gaussianTaps() {
  constexpr double kSigma = 1.5;
  std::array<double, kSsimRadius + 1> taps{};
  double sum = 0;
  for (size_t offset = 0; offset <= kSsimRadius; ++offset) {
    const double t = static_cast<double>(offset) / kSigma;
    taps[offset] = std::exp(-0.5 * t * t);
    sum += offset == 0 ? taps[offset] : 2 * taps[offset];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

// One row of one channel (0..2, or 3 for luma) as floats.
void channelRow(const Image8& image, size_t channel, size_t y, float* out) {
  const uint8_t* codes = image.pixels.data() + y * image.width * 3;
  if (channel < 3) {
    for (size_t x = 0; x < image.width; ++x) out[x] = codes[3 * x + channel];
  } else {
    for (size_t x = 0; x < image.width; ++x)
      out[x] = std::floor(0.2126f * codes[3 * x] + 0.7152f * codes[3 * x + 1] + 0.0722f * codes[3 * x + 2] + 0.5f);
  }
}

// Window means and variances in double: done once per reference, so plain loops do.
void windowMoments(const Plane& values, const std::array<double, kSsimRadius + 1>& taps, DoublePlane& mean,
                   DoublePlane& variance) {
  tbb::parallel_for(size_t{0}, mean.height(), [&](size_t y) {
    std::vector<double> sums(values.width()), squares(values.width());
    const auto weight = [&](size_t i) { return taps[i < kSsimRadius ? kSsimRadius - i : i - kSsimRadius]; };
    for (size_t i = 0; i < kSsimTaps; ++i) {
      const float* row = values.row(y + i);
      for (size_t x = 0; x < values.width(); ++x) {
        sums[x] += weight(i) * row[x];
        squares[x] += weight(i) * row[x] * row[x];
      }
    }
    for (size_t x = 0; x < mean.width(); ++x) {
      double m = 0, s = 0;
      for (size_t i = 0; i < kSsimTaps; ++i) {
        m += weight(i) * sums[x + i];
        s += weight(i) * squares[x + i];
      }
      mean.row(y)[x] = m;
      variance.row(y)[x] = s - m * m;
    }
  });
}

}  // namespace

PreparedSsim::PreparedSsim(const Image8& reference, Isa isa) : isa_(isa) {
  const size_t width = reference.width, height = reference.height;
  if (std::min(width, height) < kSsimSmallestSide)
    throw std::invalid_argument("SSIM needs at least " + std::to_string(kSsimSmallestSide) + " pixels on each side");
  taps_ = gaussianTaps();
  for (size_t c = 0; c < kPlanes; ++c) {
    Channel& channel = channels_[c];
    channel.values = Plane(width, height);
    for (size_t y = 0; y < height; ++y) channelRow(reference, c, y, channel.values.row(y));
    channel.mean = DoublePlane(width - 2 * kSsimRadius, height - 2 * kSsimRadius);
    channel.variance = DoublePlane(width - 2 * kSsimRadius, height - 2 * kSsimRadius);
    windowMoments(channel.values, taps_, channel.mean, channel.variance);
  }
}

// Rows of windows firstRow .. firstRow + rowSums.size() of one channel.
void PreparedSsim::compareRows(const Image8& test, size_t channel, size_t firstRow, std::span<double> rowSums,
                               Plane* map) const {
  const Channel& reference = channels_[channel];
  const size_t width = reference.values.width(), windows = reference.mean.width();
  const size_t inputRows = rowSums.size() + kSsimTaps - 1;
  Plane difference(width + kPlaneLanes, inputRows), values(width + kPlaneLanes, inputRows);
  for (size_t i = 0; i < inputRows; ++i) {
    float* y = values.row(i);
    channelRow(test, channel, firstRow + i, y);
    const float* x = reference.values.row(firstRow + i);
    float* d = difference.row(i);
    for (size_t column = 0; column < width; ++column) d[column] = x[column] - y[column];
  }
  AlignedArray<double> scratch(3 * (roundUpToLanes(width) + kPlaneLanes));
  Plane oneRow(windows, 1);
  const auto kernel = metricKernels(isa_).ssimRow;
  for (size_t i = 0; i < rowSums.size(); ++i) {
    SsimRow row{};
    for (size_t tap = 0; tap < kSsimTaps; ++tap) {
      row.difference[tap] = difference.row(i + tap);
      row.test[tap] = values.row(i + tap);
    }
    row.referenceMean = reference.mean.row(firstRow + i);
    row.referenceVariance = reference.variance.row(firstRow + i);
    row.taps = taps_;
    row.windows = windows;
    row.scratch = scratch.data();
    row.map = map ? map->row(firstRow + i) : oneRow.row(0);
    rowSums[i] = kernel(row);
  }
}

SsimResult PreparedSsim::compare(const Image8& test, bool withMap) const {
  const size_t rows = channels_[0].mean.height(), windows = channels_[0].mean.width();
  std::array<std::vector<double>, kPlanes> rowSums;
  std::array<Plane, 3> maps;
  for (auto& sums : rowSums) sums.resize(rows);
  if (withMap)
    for (Plane& map : maps) map = Plane(windows, rows);

  const size_t bands = (rows + kBandRows - 1) / kBandRows;
  tbb::parallel_for(size_t{0}, bands * kPlanes, [&](size_t task) {
    const size_t channel = task % kPlanes, first = task / kPlanes * kBandRows;
    const std::span<double> sums = std::span(rowSums[channel]).subspan(first, std::min(kBandRows, rows - first));
    compareRows(test, channel, first, sums, withMap && channel < 3 ? &maps[channel] : nullptr);
  });

  SsimResult result;
  const auto meanOf = [&](size_t channel) {
    return std::accumulate(rowSums[channel].begin(), rowSums[channel].end(), 0.0) / static_cast<double>(rows * windows);
  };
  for (size_t c = 0; c < 3; ++c) result.channels[c] = meanOf(c);
  result.mean = (result.channels[0] + result.channels[1] + result.channels[2]) / 3;
  result.luma = meanOf(3);
  if (withMap) {
    result.map.reserve(test.pixelCount());
    for (size_t y = 0; y < test.height; ++y) {
      const size_t row = std::clamp(y, kSsimRadius, kSsimRadius + rows - 1) - kSsimRadius;
      for (size_t x = 0; x < test.width; ++x) {
        const size_t column = std::clamp(x, kSsimRadius, kSsimRadius + windows - 1) - kSsimRadius;
        result.map.push_back((maps[0].row(row)[column] + maps[1].row(row)[column] + maps[2].row(row)[column]) / 3);
      }
    }
  }
  return result;
}

}  // namespace wavecrest
