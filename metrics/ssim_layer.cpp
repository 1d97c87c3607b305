#include "metrics/ssim_layer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace {

constexpr size_t kBandRows = 32;  // rows of one task: its samples stay in a core's L2

using Taps = std::array<double, kSsimRadius + 1>;

// Weights of the centre and of the offsets 1..5 on either side; all eleven sum to 1.
Taps gaussianTaps() {
  constexpr double kSigma = 1.5;
  Taps taps{};
  double sum = 0;
  for (size_t offset = 0; offset <= kSsimRadius; ++offset) {
    const double t = static_cast<double>(offset) / kSigma;
    taps[offset] = std::exp(-0.5 * t * t);
    sum += offset == 0 ? taps[offset] : 2 * taps[offset];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

// Window means and variances in double: done once per reference, so plain loops do.
void windowMoments(const Plane& values, size_t channels, const Taps& taps, Plane& mean, Plane& variance) {
  // Weight of row or sample i of the window, 0..10.
  const auto weight = [&](size_t i) { return taps[i < kSsimRadius ? kSsimRadius - i : i - kSsimRadius]; };
  tbb::parallel_for(size_t{0}, mean.height(), [&](size_t y) {
    // Down the columns: weighted sums of the samples and of their squares.
    std::vector<double> sums(values.width()), squares(values.width());
    for (size_t i = 0; i < kSsimTaps; ++i) {
      const float* row = values.row(y + i);
      for (size_t x = 0; x < values.width(); ++x) {
        sums[x] += weight(i) * row[x];
        squares[x] += weight(i) * row[x] * row[x];
      }
    }
    // Along the row: the samples of one channel are `channels` apart. The variance is E[x^2] - E[x]^2.
    for (size_t x = 0; x < mean.width(); ++x) {
      double m = 0, s = 0;
      for (size_t i = 0; i < kSsimTaps; ++i) {
        m += weight(i) * sums[x + i * channels];
        s += weight(i) * squares[x + i * channels];
      }
      mean.row(y)[x] = static_cast<float>(m);
      variance.row(y)[x] = static_cast<float>(s - m * m);
    }
  });
}

}  // namespace

PreparedSsimLayer::PreparedSsimLayer(Plane values, size_t channels, SsimConstants constants, Isa isa)
    : isa_(isa), channels_(channels), constants_(constants), values_(std::move(values)) {
  const Taps taps = gaussianTaps();
  std::transform(taps.begin(), taps.end(), taps_.begin(), [](double t) { return static_cast<float>(t); });
  // Windows lie inside the layer, so a row has ten windows fewer than pixels, and a column ten fewer than rows.
  const size_t windows = values_.width() - 2 * kSsimRadius * channels, rows = values_.height() - 2 * kSsimRadius;
  mean_ = Plane(windows, rows, kSsimSlack);
  variance_ = Plane(windows, rows, kSsimSlack);
  windowMoments(values_, channels, taps, mean_, variance_);
}

size_t PreparedSsimLayer::bands() const { return (windowRows() + kBandRows - 1) / kBandRows; }

void PreparedSsimLayer::compareBand(size_t bandIndex, const TestRows& testRows, SsimSums* rowSums, Plane* map) const {
  const size_t width = values_.width(), windows = rowWindows();
  const size_t firstRow = bandIndex * kBandRows, rows = std::min(kBandRows, windowRows() - firstRow);

  // Samples of the test image and their difference from the reference. The buffers stay with the thread: fresh pages
  // would cost more than the arithmetic.
  thread_local Plane values, difference, oneRow;
  if (values.width() < width) {
    values = Plane(width, kBandRows + kSsimTaps - 1, kSsimSlack);
    difference = Plane(width, kBandRows + kSsimTaps - 1, kSsimSlack);
    oneRow = Plane(width, 1, kSsimSlack);
  }
  // The windows of the band's last row reach ten rows below it.
  for (size_t i = 0; i < rows + kSsimTaps - 1; ++i) {
    float* y = values.row(i);
    float* d = difference.row(i);
    const float* x = values_.row(firstRow + i);
    testRows(firstRow + i, y);
    for (size_t column = 0; column < width; ++column) d[column] = x[column] - y[column];
  }

  // One call of the kernel for each row of windows. The kernel always writes its values. Where no map is asked for,
  // they go to a scratch row.
  const auto kernel = metricKernels(isa_).ssimRow;
  for (size_t i = 0; i < rows; ++i) {
    SsimRow row{};
    for (size_t tap = 0; tap < kSsimTaps; ++tap) {
      row.difference[tap] = difference.row(i + tap);
      row.test[tap] = values.row(i + tap);
    }
    row.referenceMean = mean_.row(firstRow + i);
    row.referenceVariance = variance_.row(firstRow + i);
    row.taps = taps_;
    row.constants = constants_;
    row.windows = windows;
    row.channels = channels_;
    row.map = map ? map->row(firstRow + i) : oneRow.row(0);
    rowSums[firstRow + i] = kernel(row);
  }
}

SsimSums PreparedSsimLayer::mean(const std::vector<SsimSums>& rowSums) const {
  // Row sums are added from top to bottom, so the mean does not depend on the number of threads.
  SsimSums mean{};
  for (const SsimSums& sums : rowSums)
    for (size_t c = 0; c < channels_; ++c) mean[c] += sums[c];
  for (double& channel : mean) channel /= static_cast<double>(windowRows() * (rowWindows() / channels_));
  return mean;
}

SsimSums PreparedSsimLayer::compare(const TestRows& testRows, Plane* map) const {
  std::vector<SsimSums> rowSums(windowRows());
  tbb::parallel_for(size_t{0}, bands(), [&](size_t band) { compareBand(band, testRows, rowSums.data(), map); });
  return mean(rowSums);
}

}  // namespace wavecrest
