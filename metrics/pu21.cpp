#include "metrics/pu21.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace {

// The encoded value that both metrics take as their peak: about that of 100 cd/m2.
constexpr double kPeak = 256;

// PSNR of a sum of squared differences. Equal images give infinity, which ends at kPu21GreatestPsnr.
double decibels(double squares, size_t samples) {
  const double meanSquare = squares / static_cast<double>(samples);
  return std::min(10 * std::log10(kPeak * kPeak / meanSquare), kPu21GreatestPsnr);
}

double squaredDistance(const float* a, const float* b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    const double d = double{a[i]} - double{b[i]};
    sum += d * d;
  }
  return sum;
}

// A plane whose rows are written by fill(y, row), in parallel.
template <class Fill>
Plane filledPlane(size_t width, size_t height, Fill fill) {
  Plane plane(width, height);
  tbb::parallel_for(size_t{0}, height, [&](size_t y) { fill(y, plane.row(y)); });
  return plane;
}

// The plane with its edge samples repeated kSsimRadius times on every side: each pixel has a window around it.
Plane extended(const Plane& plane) {
  return filledPlane(plane.width() + 2 * kSsimRadius, plane.height() + 2 * kSsimRadius, [&](size_t y, float* out) {
    const float* row = plane.row(std::clamp(y, kSsimRadius, kSsimRadius + plane.height() - 1) - kSsimRadius);
    std::fill_n(out, kSsimRadius, row[0]);
    std::copy_n(row, plane.width(), out + kSsimRadius);
    std::fill_n(out + kSsimRadius + plane.width(), kSsimRadius, row[plane.width() - 1]);
  });
}

}  // namespace

PreparedPu21::PreparedPu21(const Image& reference, double exposure, Isa isa)
    : isa_(isa),
      scale_(static_cast<float>(kPu21WhiteLuminance * std::exp2(exposure))),
      colours_(filledPlane(size_t{reference.width} * 3, reference.height,
                           [&](size_t y, float* out) { encodeColours(reference, y, out); })),
      luminance_(filledPlane(reference.width, reference.height,
                             [&](size_t y, float* out) { encodeLuminance(reference, y, out); })),
      layer_(extended(luminance_), 1, ssimConstants(kPeak), isa) {}

void PreparedPu21::encodeColours(const Image& light, size_t y, float* out) const {
  const size_t count = size_t{light.width} * 3;
  const float* row = light.pixels.data() + y * count;
  // Light becomes cd/m2, and the kernel encodes it in place.
  for (size_t i = 0; i < count; ++i) out[i] = scale_ * row[i];
  metricKernels(isa_).pu21Row({.light = out, .count = count, .out = out});
}

void PreparedPu21::encodeLuminance(const Image& light, size_t y, float* out) const {
  // Luminance of Rec. 709 primaries in cd/m2, encoded in place.
  const float* pixel = light.pixels.data() + y * light.width * 3;
  for (size_t x = 0; x < light.width; ++x, pixel += 3)
    out[x] = scale_ * (0.212656f * pixel[0] + 0.715158f * pixel[1] + 0.072186f * pixel[2]);
  metricKernels(isa_).pu21Row({.light = out, .count = light.width, .out = out});
}

Pu21PsnrResult PreparedPu21::psnr(const Image& test, bool withMap) const {
  const size_t width = test.width, height = test.height;
  std::vector<double> colourRows(height), luminanceRows(height);
  Pu21PsnrResult result;
  if (withMap) result.map.resize(width * height);
  tbb::parallel_for(size_t{0}, height, [&](size_t y) {
    // One buffer of the thread holds the encoded luminance of the row, then its encoded channels.
    thread_local AlignedArray<float> buffer;
    if (buffer.size() < roundUpToLanes(3 * width)) buffer = AlignedArray<float>(roundUpToLanes(3 * width));
    float* row = buffer.data();
    encodeLuminance(test, y, row);
    luminanceRows[y] = squaredDistance(row, luminance_.row(y), width);
    encodeColours(test, y, row);
    colourRows[y] = squaredDistance(row, colours_.row(y), 3 * width);
    // Map: root mean square of the three channels' differences at each pixel.
    for (size_t x = 0; withMap && x < width; ++x) {
      const double squares = squaredDistance(row + 3 * x, colours_.row(y) + 3 * x, 3);
      result.map[y * width + x] = static_cast<float>(std::sqrt(squares / 3));
    }
  });
  // Rows are added in order, so the scores do not depend on the number of threads.
  double colours = 0, luminance = 0;
  for (size_t y = 0; y < height; ++y) {
    colours += colourRows[y];
    luminance += luminanceRows[y];
  }
  result.colour = decibels(colours, 3 * width * height);
  result.luminance = decibels(luminance, width * height);
  return result;
}

Pu21SsimResult PreparedPu21::ssim(const Image& test, bool withMap) const {
  const Plane values =
      extended(filledPlane(test.width, test.height, [&](size_t y, float* out) { encodeLuminance(test, y, out); }));
  // The extended luminance has one window for each pixel, so the map has the image's size.
  Plane map;
  if (withMap) map = Plane(layer_.rowWindows(), layer_.windowRows(), kSsimSlack);
  const auto testRows = [&](size_t y, float* out) { std::copy_n(values.row(y), values.width(), out); };
  Pu21SsimResult result{layer_.compare(testRows, withMap ? &map : nullptr)[0], {}};
  for (size_t y = 0; withMap && y < test.height; ++y)
    result.map.insert(result.map.end(), map.row(y), map.row(y) + test.width);
  return result;
}

}  // namespace wavecrest
