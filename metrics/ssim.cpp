#include "metrics/ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace wavecrest {
namespace {

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

PreparedSsimLayer layerOf(const Image8& reference, size_t channels, Isa isa) {
  if (std::min(reference.width, reference.height) < kSsimSmallestSide)
    throw std::invalid_argument("SSIM needs at least " + std::to_string(kSsimSmallestSide) + " pixels on each side");
  Plane values(reference.width * channels, reference.height);
  for (size_t y = 0; y < reference.height; ++y) rowSamples(reference, channels, y, values.row(y));
  return {std::move(values), channels, ssimConstants(255), isa};
}

}  // namespace

PreparedSsim::PreparedSsim(const Image8& reference, Isa isa)
    : colour_(layerOf(reference, 3, isa)), luma_(layerOf(reference, 1, isa)) {}

SsimResult PreparedSsim::compare(const Image8& test, bool withMap) const {
  const size_t rows = colour_.windowRows(), windows = luma_.rowWindows();
  std::vector<SsimSums> colourSums(rows), lumaSums(rows);
  Plane map;
  if (withMap) map = Plane(windows * 3, rows, kSsimSlack);

  // Bands of both layers in one loop, so that no core waits between them.
  tbb::parallel_for(size_t{0}, 2 * colour_.bands(), [&](size_t task) {
    const bool colour = task < colour_.bands();
    const PreparedSsimLayer& layer = colour ? colour_ : luma_;
    layer.compareBand(
        task % colour_.bands(), [&](size_t y, float* out) { rowSamples(test, layer.channels(), y, out); },
        colour ? colourSums.data() : lumaSums.data(), withMap && colour ? &map : nullptr);
  });

  SsimResult result;
  result.channels = colour_.mean(colourSums);
  result.luma = luma_.mean(lumaSums)[0];
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
