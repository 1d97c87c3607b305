#include "engine/load/bmp.h"

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

namespace wavecrest {

namespace {

// The fields of the file header (14 bytes) and the info header (at least 40 bytes) that decoding needs.
struct BmpLayout {
  uint32_t dataOffset = 0, headerSize = 0, compression = 0, colorsUsed = 0;
  int32_t width = 0, height = 0;  // a negative height: the top row comes first
  uint16_t bitsPerPixel = 0;
  std::array<uint64_t, 3> channelAt{2, 1, 0};  // the byte of red, green and blue within a pixel
};

// The number at byte `at`, on a little-endian machine. The caller has checked that the file is long enough.
template <class T>
T littleEndian(std::span<const char> bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// The byte of red, green and blue within a pixel, by the bit masks after the first 40 bytes of the info header.
std::array<uint64_t, 3> readMasks(const std::string& path, std::span<const char> bytes, unsigned bitsPerPixel) {
  std::array<uint64_t, 3> channelAt{};
  size_t at = 54;  // within the file
  for (uint64_t& channel : channelAt) {
    const uint32_t mask = at + 4 <= bytes.size() ? littleEndian<uint32_t>(bytes, at) : 0;
    const auto shift = static_cast<unsigned>(std::countr_zero(mask));
    if (shift >= bitsPerPixel || shift % 8 != 0 || mask >> shift != 0xff) {
      throw ImageError(path, "BMP whose masks are not whole bytes", "expected 8 bits for each channel");
    }
    channel = shift / 8;
    at += 4;
  }
  return channelAt;
}

// Reads and checks the headers. ImageError if the file is no BMP, or of a kind that decodeBmp cannot decode.
BmpLayout readLayout(const std::string& path, std::span<const char> bytes) {
  constexpr size_t kFileHeader = 14, kInfoHeader = 40;
  if (bytes.size() < kFileHeader + kInfoHeader || bytes[0] != 'B' || bytes[1] != 'M') {
    throw ImageError(path, "no BMP header", "expected a BMP file");
  }
  BmpLayout layout{.dataOffset = littleEndian<uint32_t>(bytes, 10),
                   .headerSize = littleEndian<uint32_t>(bytes, 14),
                   .compression = littleEndian<uint32_t>(bytes, 30),
                   .colorsUsed = littleEndian<uint32_t>(bytes, 46),
                   .width = littleEndian<int32_t>(bytes, 18),
                   .height = littleEndian<int32_t>(bytes, 22),
                   .bitsPerPixel = littleEndian<uint16_t>(bytes, 28)};
  // Pixels of 8 bits are indices into the palette; pixels of 24 and 32 bits are colours.
  const bool palette = layout.bitsPerPixel == 8, direct = layout.bitsPerPixel == 24 || layout.bitsPerPixel == 32;
  const bool masks = layout.compression == 3 && direct;
  if (layout.headerSize < kInfoHeader || !(palette || direct) || !(layout.compression == 0 || masks)) {
    throw ImageError(
        path,
        "BMP of " + std::to_string(layout.bitsPerPixel) + " bits and compression " + std::to_string(layout.compression),
        "expected 8, 24 or 32 bits, uncompressed");
  }
  if (masks) layout.channelAt = readMasks(path, bytes, layout.bitsPerPixel);
  return layout;
}

}  // namespace

ImageFile decodeBmp(const std::string& path, std::span<const char> bytes) {
  const BmpLayout layout = readLayout(path, bytes);
  // Check the image size against the file. Rows are padded to multiples of 4 bytes.
  const uint64_t width = layout.width > 0 ? static_cast<uint64_t>(layout.width) : 0;
  const uint64_t height = static_cast<uint64_t>(std::llabs(layout.height));
  const uint64_t pixelBytes = layout.bitsPerPixel / 8u, rowBytes = (width * pixelBytes + 3) / 4 * 4;
  if (width == 0 || height == 0 || layout.dataOffset > bytes.size() ||
      height > (bytes.size() - layout.dataOffset) / rowBytes) {
    throw ImageError(path,
                     "BMP of " + std::to_string(layout.width) + " x " + std::to_string(layout.height) + " pixels in " +
                         std::to_string(bytes.size()) + " bytes",
                     "expected an intact file");
  }
  // The palette follows the headers, with 4 bytes per colour. A count of 0 stands for 256 colours.
  const uint64_t paletteAt = uint64_t{14} + layout.headerSize;
  const uint64_t colors = layout.bitsPerPixel != 8 ? 0 : layout.colorsUsed != 0 ? layout.colorsUsed : 256;
  if (paletteAt + 4 * colors > bytes.size() || colors > 256) {
    throw ImageError(path, "palette of " + std::to_string(colors) + " colours", "expected one within the file");
  }

  ImageFile file;
  file.encoding = Encoding::srgb8;
  file.image.width = static_cast<uint32_t>(width);
  file.image.height = static_cast<uint32_t>(height);
  file.image.pixels.reserve(3 * width * height);
  // Decode the pixels from the top row down. The file has the bottom row first, unless its height is negative.
  for (uint64_t y = 0; y < height; ++y) {
    const uint64_t row = layout.height > 0 ? height - 1 - y : y;
    for (uint64_t x = 0; x < width; ++x) {
      uint64_t at = layout.dataOffset + row * rowBytes + x * pixelBytes;
      if (colors != 0) {
        const auto index = static_cast<unsigned char>(bytes[at]);
        if (index >= colors) {
          throw ImageError(path, "pixel of colour " + std::to_string(index), "expected one of the palette");
        }
        at = paletteAt + uint64_t{4} * index;
      }
      // Without masks the bytes are blue, green and red. A fourth byte is ignored.
      for (const uint64_t channel : layout.channelAt) {
        file.image.pixels.push_back(static_cast<float>(static_cast<unsigned char>(bytes[at + channel])) / 255.0f);
      }
    }
  }
  return file;
}

}  // namespace wavecrest
