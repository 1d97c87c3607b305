// Images as the whole project exchanges them: what readers return, what writers take, what metrics compare.
//
// Image holds floats as read or rendered; Image8 holds the 8-bit gamma-corrected codes that the perceptual metrics are
// defined on. Both are row-major from the top row, channels interleaved. Nothing here knows of rendering.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace wavecrest {

struct Image {
  uint32_t width = 0, height = 0;
  uint32_t channels = 3;      // 1 or 3
  std::vector<float> pixels;  // width * height * channels

  size_t pixelCount() const { return size_t{width} * height; }
};

// RGB codes 0..255.
struct Image8 {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> pixels;  // width * height * 3

  size_t pixelCount() const { return size_t{width} * height; }
};

// What the numbers of a file mean: light (EXR, PFM, HDR), or codes of an sRGB curve scaled to 0..1 (PNG).
enum class Encoding { linear, srgb8, srgb16 };

// A file as read: always three channels, grey replicated, alpha dropped.
struct ImageFile {
  Image image;
  Encoding encoding = Encoding::linear;
  std::map<std::string, std::string> metadata;  // string attributes of an EXR header
  std::array<int32_t, 2> corner{};              // of an EXR's data window, top left; {0, 0} of other files
  // Of a Radiance file: what its channels have been multiplied by, if that is above 0.
  std::array<double, 3> exposure{1, 1, 1};
  std::string primaries{};  // of a Radiance file: those that it names, if they are neither Rec. 709's nor Radiance's
  bool otherGamma = false;  // of a PNG: it names another gamma than that of sRGB, and not sRGB itself
};

// An image file that cannot be read or written. The text is complete: "FILE: what is wrong; what was expected".
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ImageError(const std::string& path, const std::string& wrong, const std::string& expected)
      : std::runtime_error(path + ": " + oneLine(wrong) + "; " + expected) {}

 private:
  // What is wrong may quote a damaged file.
  static std::string oneLine(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 32) c = '?';
    return text;
  }
};

}  // namespace wavecrest
