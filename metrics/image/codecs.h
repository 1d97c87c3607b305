// The decoders behind readImage, one file each, and what they share. Internal to wavecrest_image.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "metrics/image/image.h"

namespace wavecrest::codecs {

using Bytes = std::span<const unsigned char>;

// Each decodes a whole file from memory; path serves error messages only. Throws ImageError.
ImageFile decodeExr(const std::string& path, Bytes bytes);
ImageFile decodePfm(const std::string& path, Bytes bytes);
ImageFile decodeHdr(const std::string& path, Bytes bytes);  // pixels as stored, whatever exposure and primaries
ImageFile decodePng(const std::string& path, Bytes bytes);

Image decodeExrLayer(const std::string& path, Bytes bytes, const std::string& layer);

// Greatest image that is read: 2^28 pixels, the greatest film that a scene may have (3.2 GB as floats).
constexpr uint64_t kMaxPixels = uint64_t{1} << 28;

// Refuses empty and oversized images, and sizes that the file cannot hold: `leastBytes` is what the smallest encoding
// of that size would take.
void checkSize(const std::string& path, uint64_t width, uint64_t height, uint64_t leastBytes, uint64_t fileBytes);

// Text from a file as it may stand in an error message: short and printable.
std::string quoted(const std::string& text);

// A cursor over the text header of PFM and HDR files.
class HeaderReader {
 public:
  explicit HeaderReader(Bytes bytes) : bytes_(bytes) {}
  std::string line();   // up to the next newline, which is consumed; at most 4 KiB
  std::string token();  // up to the next white space, of which one character or a CR LF is consumed
  bool atEnd() const { return position_ >= bytes_.size(); }
  Bytes rest() const { return bytes_.subspan(position_); }

 private:
  Bytes bytes_;
  size_t position_ = 0;
};

}  // namespace wavecrest::codecs
