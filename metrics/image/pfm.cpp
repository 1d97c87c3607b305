// PFM (portable float map): a three-line text header, then floats from the bottom row up. "PF" is colour, "Pf" grey;
// the third line's sign tells the byte order (negative: little-endian), its magnitude is a factor of all numbers.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "metrics/image/atomic_file.h"
#include "metrics/image/codecs.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace codecs {
namespace {

// Width or height from the header, below 2^32. Zero is left to checkSize.
uint64_t parseExtent(const std::string& path, const std::string& text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value > UINT32_MAX) {
    throw ImageError(path, "bad extent " + quoted(text) + " in the PFM header", "expected a positive whole number");
  }
  return value;
}

// The number of the header's third line, not zero.
double parseScale(const std::string& path, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value == 0) {
    throw ImageError(path, "bad scale " + quoted(text) + " in the PFM header", "expected a number other than zero");
  }
  return value;
}

// The float in four bytes of the given order.
float floatAt(const unsigned char* bytes, bool littleEndian) {
  uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  const bool swap = littleEndian != (std::endian::native == std::endian::little);
  return std::bit_cast<float>(swap ? __builtin_bswap32(bits) : bits);
}

}  // namespace

ImageFile decodePfm(const std::string& path, Bytes bytes) {
  // Header: kind, size, byte order.
  HeaderReader header(bytes);
  const std::string magic = header.token();
  if (magic != "PF" && magic != "Pf") throw ImageError(path, "not a PFM file", "expected it to start with PF or Pf");
  const uint64_t width = parseExtent(path, header.token());
  const uint64_t height = parseExtent(path, header.token());
  const double signedScale = parseScale(path, header.token()), scale = std::abs(signedScale);
  const bool littleEndian = signedScale < 0;
  const uint64_t fileChannels = magic == "PF" ? 3 : 1;
  // The first check bounds the size, so that the byte count of the second cannot overflow.
  checkSize(path, width, height, 0, 0);
  const Bytes data = header.rest();
  checkSize(path, width, height, width * height * fileChannels * sizeof(float), data.size());

  // The file's last row is the image's first. Grey is replicated to three channels.
  ImageFile file;
  file.image = {static_cast<uint32_t>(width), static_cast<uint32_t>(height), 3, {}};
  file.image.pixels.resize(width * height * 3);
  for (uint64_t y = 0; y < height; ++y) {
    const unsigned char* row = data.data() + (height - 1 - y) * width * fileChannels * sizeof(float);
    float* out = file.image.pixels.data() + y * width * 3;
    for (uint64_t i = 0; i < width * 3; ++i) {
      out[i] = floatAt(row + (fileChannels == 3 ? i : i / 3) * sizeof(float), littleEndian);
    }
  }
  // Nearly every file has a scale of 1.
  if (scale != 1) {
    for (float& value : file.image.pixels) value = static_cast<float>(value * scale);
  }
  return file;
}

}  // namespace codecs

void writePfm(const std::string& path, const Image& image) {
  const std::string header = std::string(image.channels == 1 ? "Pf" : "PF") + "\n" + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  const size_t rowBytes = size_t{image.width} * image.channels * sizeof(float);
  // The header, then the rows from the bottom up.
  std::vector<unsigned char> bytes(header.size() + rowBytes * image.height);
  std::memcpy(bytes.data(), header.data(), header.size());
  static_assert(std::endian::native == std::endian::little, "rows are copied as they are in memory");
  for (size_t y = 0; y < image.height; ++y) {
    std::memcpy(bytes.data() + header.size() + (image.height - 1 - y) * rowBytes,
                image.pixels.data() + y * image.width * image.channels, rowBytes);
  }
  writeFileAtomically(path, bytes);
}

}  // namespace wavecrest
