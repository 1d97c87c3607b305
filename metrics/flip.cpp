#include "metrics/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

// Mean of the map and, if asked for, the map itself. Row sums are added in order, so the mean does not depend on the
// number of threads.
FlipResult resultOf(const Plane& map, bool withMap) {
  std::vector<double> rows(map.height());
  tbb::parallel_for(size_t{0}, map.height(),
                    [&](size_t y) { rows[y] = std::accumulate(map.row(y), map.row(y) + map.width(), 0.0); });
  FlipResult result;
  result.mean = std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(map.pixelCount());
  if (withMap)
    for (size_t y = 0; y < map.height(); ++y) result.map.insert(result.map.end(), map.row(y), map.row(y) + map.width());
  return result;
}

// Planes for Y, Cx and Cz.
FlipModel::Opponents makeOpponents(size_t width, size_t height) {
  return {Plane(width, height), Plane(width, height), Plane(width, height)};
}

}  // namespace

// ---- LDR ------------------------------------------------------------------------------------------------------------

PreparedFlip::PreparedFlip(const Image8& reference, double pixelsPerDegree, Isa isa) : model_(pixelsPerDegree, isa) {
  // Opponent colours are affine in linear RGB, so each code of each channel adds its own share. The constant term is in
  // the shares of the red channel alone.
  const auto& decode = srgbDecodeTable();
  const auto black = FlipModel::opponent(0, 0, 0);
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t code = 0; code < 256; ++code) {
      const double light = decode[code];
      const auto opponent =
          FlipModel::opponent(channel == 0 ? light : 0, channel == 1 ? light : 0, channel == 2 ? light : 0);
      for (size_t i = 0; i < 3; ++i) codeOpponents_[channel][i][code] = opponent[i] - (channel == 0 ? 0 : black[i]);
    }
  }
  reference_ = model_.analyze(opponents(reference));
}

// Opponent colours of an image of codes: for each pixel, the sum of the shares of its three codes.
FlipModel::Opponents PreparedFlip::opponents(const Image8& image) const {
  auto planes = makeOpponents(image.width, image.height);
  tbb::parallel_for(size_t{0}, size_t{image.height}, [&](size_t y) {
    const uint8_t* codes = image.pixels.data() + y * image.width * 3;
    for (size_t i = 0; i < 3; ++i) {
      const auto &red = codeOpponents_[0][i], &green = codeOpponents_[1][i], &blue = codeOpponents_[2][i];
      float* row = planes[i].row(y);
      for (size_t x = 0; x < image.width; ++x)
        row[x] = red[codes[3 * x]] + green[codes[3 * x + 1]] + blue[codes[3 * x + 2]];
    }
  });
  return planes;
}

FlipResult PreparedFlip::compare(const Image8& test, bool withMap) const {
  Plane map(test.width, test.height);
  model_.compare(reference_, opponents(test), map);
  return resultOf(map, withMap);
}

// ---- HDR ------------------------------------------------------------------------------------------------------------

namespace {

// The filmic curve of ACES in Narkowicz's fit, (a x^2 + b x + c) / (d x^2 + e x + f), exposure 0.6 included.
constexpr double kAcesA = 0.36 * 2.51, kAcesB = 0.6 * 0.03, kAcesD = 0.36 * 2.43, kAcesE = 0.6 * 0.59, kAcesF = 0.14;

// The curve's value, 0..1, at linear light x. Light that is negative or not finite is black.
double toneMap(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  x = std::min(x, 1e15);  // the curve is flat long before its squares overflow
  return std::min((kAcesA * x + kAcesB) * x / ((kAcesD * x + kAcesE) * x + kAcesF), 1.0);
}

// The light that the curve maps to 0.85.
double brightLevel() {
  constexpr double kBright = 0.85;
  // The curve is kBright where a x^2 + b x + c = 0. The light is the positive root.
  const double a = kBright * kAcesD - kAcesA, b = kBright * kAcesE - kAcesB, c = kBright * kAcesF;
  const double half = -0.5 * b / a, root = std::sqrt(half * half - c / a);
  return std::max(half - root, half + root);
}

// Exposures in stops, evenly spaced. The first shows the brightest pixel at 0.85, the last shows the median there.
std::vector<double> exposureSeries(const Image& reference) {
  // Luminance of the pixels with finite light.
  std::vector<double> luminances;
  for (size_t i = 0; i + 2 < reference.pixels.size(); i += 3) {
    const double y = 0.2126 * reference.pixels[i] + 0.7152 * reference.pixels[i + 1] + 0.0722 * reference.pixels[i + 2];
    if (std::isfinite(y)) luminances.push_back(y);
  }
  if (luminances.empty()) return {0};
  // Median and greatest luminance.
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double greatest = *std::max_element(luminances.begin(), luminances.end());
  constexpr double kDarkestMedian = 0x1p-23;  // half-black images still get a finite series
  if (!(greatest > 0)) return {0};
  // The ends of the series. It has as many exposures as there are stops between the ends, rounded up, and at least two.
  const double start = std::log2(brightLevel() / greatest);
  const double stop = std::log2(brightLevel() / std::max(*middle, std::min(kDarkestMedian, greatest)));
  const auto count = static_cast<size_t>(std::max(2.0, std::ceil(stop - start)));
  std::vector<double> exposures;
  for (size_t i = 0; i < count; ++i)
    exposures.push_back(start + (stop - start) * static_cast<double>(i) / static_cast<double>(count - 1));
  return exposures;
}

// Opponent colours of light that is multiplied by 2^exposure and tone-mapped.
FlipModel::Opponents exposedOpponents(const Image& image, double exposure) {
  auto planes = makeOpponents(image.width, image.height);
  const double factor = std::exp2(exposure);
  tbb::parallel_for(size_t{0}, size_t{image.height}, [&](size_t y) {
    const float* pixel = image.pixels.data() + y * image.width * 3;
    for (size_t x = 0; x < image.width; ++x, pixel += 3) {
      const auto opponent =
          FlipModel::opponent(toneMap(factor * pixel[0]), toneMap(factor * pixel[1]), toneMap(factor * pixel[2]));
      for (size_t i = 0; i < 3; ++i) planes[i].row(y)[x] = opponent[i];
    }
  });
  return planes;
}

}  // namespace

PreparedHdrFlip::PreparedHdrFlip(const Image& reference, double pixelsPerDegree, Isa isa)
    : model_(pixelsPerDegree, isa), exposures_(exposureSeries(reference)) {
  for (size_t i = 0; i < std::min(kKeptExposures, exposures_.size()); ++i)
    references_.push_back(model_.analyze(exposedOpponents(reference, exposures_[i])));
  if (references_.size() < exposures_.size()) light_ = reference;
}

FlipResult PreparedHdrFlip::compare(const Image& test, bool withMap) const {
  Plane map(test.width, test.height);
  // The map starts at zero and keeps the greatest error of all exposures (FlipModel::compare).
  for (size_t i = 0; i < exposures_.size(); ++i) {
    const FlipModel::Opponents exposed = exposedOpponents(test, exposures_[i]);
    if (i < references_.size()) {
      model_.compare(references_[i], exposed, map);
    } else {
      model_.compare(model_.analyze(exposedOpponents(light_, exposures_[i])), exposed, map);
    }
  }
  return resultOf(map, withMap);
}

}  // namespace wavecrest
