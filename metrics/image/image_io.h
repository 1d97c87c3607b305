// Reading and writing image files. The format follows from the file's extension: .exr .pfm .hdr .png.
//
// Readers take any well-formed file of these formats and refuse everything else with one ImageError; they never trust a
// size in a header before the file's length makes it plausible. Writers never leave a half-written file behind: they
// write a temporary name beside the target, flush it to the device and rename it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/image/image.h"

namespace wavecrest {

using Metadata = std::map<std::string, std::string>;

// What a decoded image may take as floats, unless the variable WAVECREST_MAX_IMAGE says otherwise ("8G"). Images that
// take at most kPlainRatio times the bytes of their file are always read: only those that a small file unpacks to are
// suspicious.
constexpr const char* kImageLimitVariable = "WAVECREST_MAX_IMAGE";
constexpr uint64_t kImageLimit = uint64_t{2} << 30, kPlainRatio = 16;

// What formats go by: the extension of a file's name in lower case with its dot, or nothing.
std::string extensionOf(const std::string& path);

// Refuses an image of three channels that is larger than this. Throws ImageError, also where the variable is no size.
void checkDecodedSize(const std::string& path, uint64_t width, uint64_t height, uint64_t fileBytes);

// Three channels, top row first. The exposure of a Radiance file is undone. Throws ImageError, also where
// that has other primaries than Rec. 709's.
ImageFile readImage(const std::string& path);

// The same of a file in memory, with the pixels of a Radiance file as stored. `extension` is that of the format, in
// lower case with its dot; path serves error messages only.
ImageFile decodeImage(const std::string& path, std::string_view extension, std::span<const unsigned char> bytes);

// A named group of channels beside the main image of an EXR, e.g. "variance" -> variance.R, variance.G, variance.B.
struct ExrLayer {
  std::string name;
  Image image;  // same size as the main image
};

// Told the part that is written so far, 0 to 1, every now and then.
using WriteProgress = std::function<void(double fraction)>;

// Of all channels of a file. Halves have 11 significant bits, and end at kLargestHalf.
enum class ExrSamples { floats, halves };
constexpr float kLargestHalf = 65504;

// Single part, ZIP-compressed scan lines. Channels R G B, or Y for one channel. Throws ImageError, also where a sample
// is beyond kLargestHalf in a file of halves.
void writeExr(const std::string& path, const Image& image, const Metadata& metadata = {},
              std::span<const ExrLayer> layers = {}, const WriteProgress& progress = {},
              ExrSamples samples = ExrSamples::floats);

// What writeExr takes besides an image of three channels: the blocks that OpenEXR's threads compress, and the file's
// buffer.
size_t exrWritingBytes(uint32_t width, uint32_t height);

// One named layer of an EXR (an empty name: the main image). Throws ImageError when it is absent.
Image readExrLayer(const std::string& path, const std::string& layer);

// Little-endian floats as they are.
void writePfm(const std::string& path, const Image& image);

// A PNG file of 8-bit sRGB in memory, from rows of RGB, top row first; path serves error messages only. Throws
// ImageError.
std::vector<unsigned char> encodePng(const std::string& path, uint32_t width, uint32_t height, const uint8_t* rgb);

// 8-bit sRGB. The second form clamps, applies the sRGB curve and rounds.
void writePng(const std::string& path, const Image8& image);
void writePng(const std::string& path, const Image& linear);

// Throws ImageError where no image can be written: an unknown extension, or as checkWritable.
void checkImageTarget(const std::string& path);

// By extension: .exr, .pfm or .png (metadata is kept by EXR only, which is also the only one to tell of its progress).
void writeImage(const std::string& path, const Image& linear, const Metadata& metadata = {},
                const WriteProgress& progress = {});

}  // namespace wavecrest
