// Images of the interface: read, written, coded.
#include "metrics/image/image.h"

#include "library/image_conversion.h"
#include "library/option_values.h"
#include "library/translate.h"
#include "metrics/false_colour.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"
#include "metrics/prepared_reference.h"
#include "wavecrest/compare.h"
#include "wavecrest/image.h"

namespace wavecrest {

void checkPixels(const std::string& name, const api::Image& image) {
  const size_t samples = 3 * size_t{image.width} * image.height;
  if (samples != 0 && image.pixels.size() == samples) return;
  throw ImageError(name, "image of " + std::to_string(image.pixels.size()) + " samples",
                   "expected 3 for each of its " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                       " pixels, and at least one");
}

Image toImage(api::Image image) {
  return {.width = image.width, .height = image.height, .channels = 3, .pixels = std::move(image.pixels)};
}

namespace api {

Image readImage(const std::string& file) {
  return translated([&]() -> Image {
    ImageFile read = wavecrest::readImage(file);
    return {.width = read.image.width,
            .height = read.image.height,
            .pixels = std::move(read.image.pixels),
            .srgb = read.encoding != Encoding::linear};
  });
}

void writeImage(const std::string& file, const Image& image) {
  translated([&] {
    checkPixels(file, image);
    if (image.srgb) throw ImageError(file, "sRGB values cannot be written", "expected linear radiance");
    checkImageTarget(file);
    wavecrest::writeImage(file, toImage(image));
  });
}

std::vector<uint8_t> srgbCodes(const Image& image, double exposure) {
  return translated([&] {
    checkPixels("image", image);
    requireInRange("--exposure", exposure, kExposureRange);
    wavecrest::Image light = toImage(image);
    if (image.srgb) light = linearLight({.image = light, .encoding = Encoding::srgb8, .metadata = {}});
    return encodeSrgb8(light, exposure).pixels;
  });
}

std::vector<uint8_t> falseColours(const std::vector<float>& map, uint32_t width, uint32_t height, double range) {
  return translated([&] {
    if (map.empty() || map.size() != size_t{width} * height) {
      throw ImageError("map", "has " + std::to_string(map.size()) + " values",
                       "expected one for each of its " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels, and at least one");
    }
    return falseColour(map, width, height, range).pixels;
  });
}

}  // namespace api
}  // namespace wavecrest
