#include "engine/load/tga.h"

#include <algorithm>

#include "metrics/image/image_io.h"

namespace wavecrest {

namespace {

// Decodes one file. Each access to a byte is checked against the end of the file.
class TgaReader {
 public:
  TgaReader(const std::string& path, std::span<const char> bytes) : path_(path), bytes_(bytes) {}

  ImageFile read() {
    readHeader();
    ImageFile file;
    file.encoding = Encoding::srgb8;
    file.image.width = static_cast<uint32_t>(width_);
    file.image.height = static_cast<uint32_t>(height_);
    file.image.pixels.resize(3 * width_ * height_);
    readPixels(file.image.pixels);
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ImageError(path_, what, "expected an intact TGA file");
  }
  size_t byte(size_t at) const {
    if (at >= bytes_.size()) fail("file ends early");
    return static_cast<unsigned char>(bytes_[at]);
  }
  // 16 bits, little-endian.
  size_t word(size_t at) const { return byte(at) + 256 * byte(at + 1); }

  // Bytes: 0 length of the id, 1 palette, 2 kind (8 more: run lengths), 3 palette's first, 5 length and 7 bits, 12
  // width, 14 height, 16 bits, 17 flags (0x20: top row first, 0x10: rightmost pixel first).
  void readHeader() {
    // The kind of pixels: 1 is a palette, 2 true colour, 3 grey.
    const size_t kind = byte(2);
    runs_ = (kind & 8) != 0;
    const size_t plainKind = kind & ~size_t{8};
    palette_ = plainKind == 1;
    const size_t pixelBits = byte(16), colorBits = palette_ ? byte(7) : pixelBits;
    const bool grey = plainKind == 3;
    const bool known = palette_ ? byte(1) == 1 && pixelBits == 8 && (colorBits == 24 || colorBits == 32)
                       : grey   ? pixelBits == 8
                                : plainKind == 2 && (pixelBits == 24 || pixelBits == 32);
    if (!known) {
      throw ImageError(path_, "TGA of kind " + std::to_string(kind) + " and " + std::to_string(pixelBits) + " bits",
                       "expected grey of 8 bits, or a palette or true colour of 24 or 32 bits");
    }
    // Sizes and positions. The id and the palette stand between the header of 18 bytes and the pixels.
    pixelBytes_ = pixelBits / 8;
    colorBytes_ = colorBits / 8;
    flags_ = byte(17);
    width_ = word(12);
    height_ = word(14);
    paletteAt_ = 18 + byte(0);
    paletteFirst_ = word(3);
    paletteLength_ = byte(1) == 1 ? word(5) : 0;
    at_ = paletteAt_ + paletteLength_ * ((byte(7) + 7) / 8);
    // A run of 128 pixels takes two bytes.
    const size_t left = bytes_.size() - std::min(bytes_.size(), at_);
    if (width_ == 0 || height_ == 0 || width_ * height_ > left * (runs_ ? 128 : 1)) {
      fail("TGA of " + std::to_string(width_) + " x " + std::to_string(height_) + " pixels in " +
           std::to_string(bytes_.size()) + " bytes");
    }
    checkDecodedSize(path_, width_, height_, bytes_.size());
  }

  // The position of the colour of the pixel at position `at`: the pixel itself, or an entry of the palette.
  size_t colorAt(size_t at) const {
    if (!palette_) return at;
    const size_t index = byte(at);
    if (index < paletteFirst_ || index - paletteFirst_ >= paletteLength_) fail("pixel of no colour of the palette");
    return paletteAt_ + (index - paletteFirst_) * colorBytes_;
  }

  // Decodes the pixels in the order of the file. `out` has the top row first.
  void readPixels(std::vector<float>& out) {
    size_t left = 0;       // pixels of the current packet
    bool repeats = false;  // whether they all have one value
    for (size_t i = 0; i < width_ * height_; ++i) {
      if (runs_ && left == 0) {
        // The packet's first byte: a bit that says whether it is a run, and the number of pixels less 1.
        const size_t packet = byte(at_++);
        left = 1 + (packet & 127);
        repeats = (packet & 128) != 0;
      }
      const size_t color = colorAt(at_);
      // Find the place of the pixel. Its colour is stored as blue, green, red.
      const size_t column = i % width_, row = i / width_;
      const size_t x = (flags_ & 0x10) != 0 ? width_ - 1 - column : column;
      const size_t y = (flags_ & 0x20) != 0 ? row : height_ - 1 - row;
      for (size_t c = 0; c < 3; ++c) {
        out[3 * (y * width_ + x) + c] = static_cast<float>(byte(color + (colorBytes_ == 1 ? 0 : 2 - c))) / 255.0f;
      }
      // Within a run, the next pixel is read from the same position.
      if (runs_) --left;
      if (!runs_ || !repeats || left == 0) at_ += pixelBytes_;
    }
  }

  const std::string& path_;
  std::span<const char> bytes_;
  size_t at_ = 0, width_ = 0, height_ = 0, pixelBytes_ = 0, colorBytes_ = 0, flags_ = 0;
  size_t paletteAt_ = 0, paletteFirst_ = 0, paletteLength_ = 0;
  bool palette_ = false, runs_ = false;
};

}  // namespace

ImageFile decodeTga(const std::string& path, std::span<const char> bytes) { return TgaReader(path, bytes).read(); }

}  // namespace wavecrest
