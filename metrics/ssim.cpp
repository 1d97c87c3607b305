#include "metrics/ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

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

// One row of samples: the interleaved codes, or the luma.
void rowSamples(const Image8& image, size_t channels, size_t y, float* out) {
  const uint8_t* codes = image.pixels.data() + y * image.width * 3;
  if (channels == 3) {
    for (size_t i = 0; i < size_t{image.width} * 3; ++i) out[i] = codes[i];
  } else {
    // Weights in 1/65536: whole-number arithmetic rounds alike everywhere.
    for (size_t x = 0; x < image.width; ++x) {
      const int luma = 13933 * codes[3 * x] + 46871 * codes[3 * x + 1] + 4732 * codes[3 * x + 2];
      out[x] = static_cast<float>((luma + 32768) >> 16);
    }
  }
}

// Window means and variances in double: done once per reference, so plain loops do.
void windowMoments(const Plane& values, size_t channels, const Taps& taps, Plane& mean, Plane& variance) {
  const auto weight = [&](size_t i) { return taps[i < kSsimRadius ? kSsimRadius - i : i - kSsimRadius]; };
  tbb::parallel_for(size_t{0}, mean.height(), [&](size_t y) {
    std::vector<double> sums(values.width()), squares(values.width());
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
        m += weight(i) * sums[x + i * channels];
        s += weight(i) * squares[x + i * channels];
      }
      mean.row(y)[x] = static_cast<float>(m);
      variance.row(y)[x] = static_cast<float>(s - m * m);
    }
  });
}

}  // namespace

PreparedSsim::PreparedSsim(const Image8& reference, Isa isa) : isa_(isa) {
  const size_t width = reference.width, height = reference.height;
  if (std::min(width, height) < kSsimSmallestSide)
    throw std::invalid_argument("SSIM needs at least " + std::to_string(kSsimSmallestSide) + " pixels on each side");
  const Taps taps = gaussianTaps();
  std::transform(taps.begin(), taps.end(), taps_.begin(), [](double t) { return static_cast<float>(t); });
  layers_[0].channels = 3;
  layers_[1].channels = 1;
  for (Layer& layer : layers_) {
    const size_t windows = (width - 2 * kSsimRadius) * layer.channels;
    layer.values = Plane(width * layer.channels, height);
    for (size_t y = 0; y < height; ++y) rowSamples(reference, layer.channels, y, layer.values.row(y));
    layer.mean = Plane(windows, height - 2 * kSsimRadius, kSsimSlack);
    layer.variance = Plane(windows, height - 2 * kSsimRadius, kSsimSlack);
    windowMoments(layer.values, layer.channels, taps, layer.mean, layer.variance);
  }
}

// Consecutive rows of windows of one layer: one task.
struct PreparedSsim::Band {
  const Layer& reference;
  size_t firstRow;
  std::span<std::array<double, 3>> rowSums;  // out
  Plane* map;                                // out, or null
};

void PreparedSsim::compareBand(const Image8& test, const Band& band) const {
  const Layer& reference = band.reference;
  const size_t width = reference.values.width(), windows = reference.mean.width();
  const size_t inputRows = band.rowSums.size() + kSsimTaps - 1;

  // Samples of the test image and their difference from the reference. The buffers stay with the thread: fresh pages
  // would cost more than the arithmetic.
  thread_local Plane values, difference, oneRow;
  if (values.width() != width || oneRow.width() != windows) {
    values = Plane(width, kBandRows + kSsimTaps - 1, kSsimSlack);
    difference = Plane(width, kBandRows + kSsimTaps - 1, kSsimSlack);
    oneRow = Plane(windows, 1, kSsimSlack);
  }
  for (size_t i = 0; i < inputRows; ++i) {
    float* y = values.row(i);
    float* d = difference.row(i);
    const float* x = reference.values.row(band.firstRow + i);
    rowSamples(test, reference.channels, band.firstRow + i, y);
    for (size_t column = 0; column < width; ++column) d[column] = x[column] - y[column];
  }

  const auto kernel = metricKernels(isa_).ssimRow;
  for (size_t i = 0; i < band.rowSums.size(); ++i) {
    SsimRow row{};
    for (size_t tap = 0; tap < kSsimTaps; ++tap) {
      row.difference[tap] = difference.row(i + tap);
      row.test[tap] = values.row(i + tap);
    }
    row.referenceMean = reference.mean.row(band.firstRow + i);
    row.referenceVariance = reference.variance.row(band.firstRow + i);
    row.taps = taps_;
    row.windows = windows;
    row.channels = reference.channels;
    row.map = band.map ? band.map->row(band.firstRow + i) : oneRow.row(0);
    band.rowSums[i] = kernel(row);
  }
}

SsimResult PreparedSsim::compare(const Image8& test, bool withMap) const {
  const size_t rows = layers_[0].mean.height(), windows = layers_[1].mean.width();
  std::array<std::vector<std::array<double, 3>>, 2> rowSums;
  for (auto& sums : rowSums) sums.resize(rows);
  Plane map;
  if (withMap) map = Plane(windows * 3, rows, kSsimSlack);

  const size_t bands = (rows + kBandRows - 1) / kBandRows;
  tbb::parallel_for(size_t{0}, bands * layers_.size(), [&](size_t task) {
    const size_t layer = task / bands, first = task % bands * kBandRows;
    const auto sums = std::span(rowSums[layer]).subspan(first, std::min(kBandRows, rows - first));
    compareBand(test, {layers_[layer], first, sums, withMap && layer == 0 ? &map : nullptr});
  });

  SsimResult result;
  const auto count = static_cast<double>(rows * windows);
  for (const auto& sums : rowSums[0])
    for (size_t c = 0; c < 3; ++c) result.channels[c] += sums[c];
  for (double& channel : result.channels) channel /= count;
  for (const auto& sums : rowSums[1]) result.luma += sums[0];
  result.luma /= count;
  result.mean = (result.channels[0] + result.channels[1] + result.channels[2]) / 3;
  if (!withMap) return result;

  result.map.reserve(test.pixelCount());
  for (size_t y = 0; y < test.height; ++y) {
    const float* row = map.row(std::clamp(y, kSsimRadius, kSsimRadius + rows - 1) - kSsimRadius);
    for (size_t x = 0; x < test.width; ++x) {
      const float* window = row + 3 * (std::clamp(x, kSsimRadius, kSsimRadius + windows - 1) - kSsimRadius);
      result.map.push_back((window[0] + window[1] + window[2]) / 3);
    }
  }
  return result;
}

}  // namespace wavecrest
