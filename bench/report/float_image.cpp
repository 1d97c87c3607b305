#include "bench/report/float_image.h"

#include <half.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "bench/report/embedded_images.h"

namespace wavecrest {
namespace {

uint16_t halfCode(float sample) {
  constexpr float kLargest = 65504;
  return Imath::half(std::isfinite(sample) ? std::clamp(sample, -kLargest, kLargest) : sample).bits();
}

}  // namespace

std::string floatText(std::span<const float> rgb, uint32_t width, uint32_t height) {
  const size_t count = size_t{width} * height;
  if (rgb.size() != 3 * count) throw std::invalid_argument("floatText: expected three samples for each pixel");
  std::vector<uint8_t> bytes(2 * rgb.size());
  size_t place = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    uint16_t above = 0;
    for (size_t y = 0; y < height; ++y) {
      uint16_t before = above;
      for (size_t x = 0; x < width; ++x, ++place) {
        const uint16_t code = halfCode(rgb[3 * (y * width + x) + channel]);
        const auto difference = static_cast<uint16_t>(code - before);
        bytes[place] = static_cast<uint8_t>(difference >> 8);
        bytes[rgb.size() + place] = static_cast<uint8_t>(difference & 255u);
        before = code;
        if (x == 0) above = code;
      }
    }
  }
  std::vector<uint8_t> packed(compressBound(bytes.size()));
  uLongf size = packed.size();
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_BEST_COMPRESSION) != Z_OK) {
    throw std::runtime_error("floatText: an image could not be compressed");
  }
  packed.resize(size);
  return base64(packed);
}

}  // namespace wavecrest
