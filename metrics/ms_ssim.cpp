#include "metrics/ms_ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace wavecrest {
namespace {

// Exponents of the scales, the finest first (Wang, Simoncelli, Bovik 2003).
constexpr std::array<double, kMsSsimScales> kScaleWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
constexpr size_t kChannels = 3;

// Codes as floats, channels interleaved.
Plane codePlane(const Image8& image) {
  Plane plane(size_t{image.width} * kChannels, image.height);
  tbb::parallel_for(size_t{0}, plane.height(), [&](size_t y) {
    const uint8_t* codes = image.pixels.data() + y * plane.width();
    float* row = plane.row(y);
    for (size_t i = 0; i < plane.width(); ++i) row[i] = codes[i];
  });
  return plane;
}

// Means of 2x2 pixels, channel by channel. A last row or column without a partner is its own partner.
Plane halved(const Plane& plane) {
  const size_t width = plane.width() / kChannels;
  Plane half((width + 1) / 2 * kChannels, (plane.height() + 1) / 2);
  tbb::parallel_for(size_t{0}, half.height(), [&](size_t y) {
    const float* upper = plane.row(2 * y);
    const float* lower = plane.row(std::min(2 * y + 1, plane.height() - 1));
    float* out = half.row(y);
    for (size_t x = 0; x < (width + 1) / 2; ++x) {
      const size_t left = 2 * x * kChannels, right = std::min(2 * x + 1, width - 1) * kChannels;
      for (size_t c = 0; c < kChannels; ++c)
        out[x * kChannels + c] = 0.25f * (upper[left + c] + upper[right + c] + lower[left + c] + lower[right + c]);
    }
  });
  return half;
}

// A factor of one scale raised to the scale's exponent. A negative factor counts as zero.
double weighted(double value, size_t scale) { return std::pow(std::max(value, 0.0), kScaleWeights[scale]); }

// Multiplies a map by the factors of one scale. The map has `width` pixels per row and interleaved channels; `windows`
// is the scale's own map.
void multiplyMap(const Plane& windows, size_t scale, uint32_t width, std::vector<float>& map) {
  const size_t height = map.size() / kChannels / width, last = windows.width() / kChannels - 1;
  for (size_t y = 0; y < height; ++y) {
    // Row y of the image is in row y >> scale of the scale. A window centred there starts kSsimRadius above; near the
    // edges, the nearest window takes its place.
    const size_t above = std::max(y >> scale, kSsimRadius) - kSsimRadius;
    const float* row = windows.row(std::min(above, windows.height() - 1));
    for (size_t x = 0; x < width; ++x) {
      const size_t column = std::min(std::max(x >> scale, kSsimRadius) - kSsimRadius, last);
      for (size_t c = 0; c < kChannels; ++c)
        map[(y * width + x) * kChannels + c] *=
            static_cast<float>(weighted(double{row[column * kChannels + c]}, scale));
    }
  }
}

}  // namespace

PreparedMsSsim::PreparedMsSsim(const Image8& reference, Isa isa) {
  if (std::min(reference.width, reference.height) < kMsSsimSmallestSide)
    throw std::invalid_argument("MS-SSIM needs at least " + std::to_string(kMsSsimSmallestSide) +
                                " pixels on each side");
  // Prepare each scale and halve the image for the next. All scales but the coarsest have the structure factor alone.
  Plane plane = codePlane(reference);
  for (size_t scale = 0; scale < kMsSsimScales; ++scale) {
    const bool coarsest = scale + 1 == kMsSsimScales;
    Plane next = coarsest ? Plane() : halved(plane);
    SsimConstants constants = ssimConstants(255);
    if (!coarsest) constants.luminance = kSsimStructureOnly;
    scales_.emplace_back(std::move(plane), kChannels, constants, isa);
    plane = std::move(next);
  }
}

MsSsimResult PreparedMsSsim::compare(const Image8& test, bool withMap) const {
  MsSsimResult result;
  result.channels.fill(1);
  // The maps and the scores are products over the scales, for each channel.
  std::vector<float> channelMap(withMap ? test.pixels.size() : 0, 1.0f);
  Plane plane = codePlane(test);
  for (size_t scale = 0; scale < kMsSsimScales; ++scale) {
    if (scale > 0) plane = halved(plane);
    const PreparedSsimLayer& layer = scales_[scale];
    Plane windows;
    if (withMap) windows = Plane(layer.rowWindows(), layer.windowRows(), kSsimSlack);
    const auto testRows = [&](size_t y, float* out) { std::copy_n(plane.row(y), plane.width(), out); };
    const SsimSums means = layer.compare(testRows, withMap ? &windows : nullptr);
    for (size_t c = 0; c < kChannels; ++c) result.channels[c] *= weighted(means[c], scale);
    if (withMap) multiplyMap(windows, scale, test.width, channelMap);
  }
  // Scores and maps of the three channels are averaged.
  result.mean = (result.channels[0] + result.channels[1] + result.channels[2]) / 3;
  for (size_t i = 0; i < channelMap.size(); i += kChannels)
    result.map.push_back((channelMap[i] + channelMap[i + 1] + channelMap[i + 2]) / 3);
  return result;
}

}  // namespace wavecrest
