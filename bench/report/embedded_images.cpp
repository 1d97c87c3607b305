#include "bench/report/png_embedding.h"

#include <fmt/format.h>
#include <png.h>

#include <stdexcept>
#include <vector>

namespace wavecrest {

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    // Three bytes become four digits of six bits; what the last group lacks is shown by '='.
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = (group << 8) | (k < count ? bytes[i + k] : 0U);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kAlphabet[(group >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

std::string pngDataUri(const ReportImage& image) {
  if (image.width == 0 || image.height == 0 || image.rgb.size() != size_t{3} * image.width * image.height) {
    throw std::invalid_argument(fmt::format("report image '{}': {} bytes; expected 3 x {} x {}", image.label,
                                            image.rgb.size(), image.width, image.height));
  }
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = image.width;
  header.height = image.height;
  header.format = PNG_FORMAT_RGB;

  // First call asks for the size, second writes.
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&header, nullptr, &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(fmt::format("report image '{}': {}", image.label, header.message));
  }
  std::vector<uint8_t> bytes(size);
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(fmt::format("report image '{}': {}", image.label, header.message));
  }
  return "data:image/png;base64," + base64(std::span(bytes).first(size));
}

}  // namespace wavecrest
