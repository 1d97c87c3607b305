#include "metrics/image/image_io.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "metrics/image/atomic_file.h"
#include "metrics/image/codecs.h"
#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

// How files of one extension are read.
struct Format {
  std::string_view extension;
  ImageFile (*decode)(const std::string& path, codecs::Bytes bytes);
};

// The list of readable formats.
constexpr std::array kFormats{
    Format{".exr", codecs::decodeExr},
    Format{".pfm", codecs::decodePfm},
    Format{".hdr", codecs::decodeHdr},
    Format{".png", codecs::decodePng},
};

[[noreturn]] void failFormat(const std::string& path, std::string_view extension, const std::string& expected) {
  const std::string wrong =
      extension.empty() ? "has no file extension" : "unknown image format '" + std::string(extension) + "'";
  throw ImageError(path, wrong, expected);
}

const Format& formatOf(const std::string& path, std::string_view extension) {
  for (const Format& format : kFormats) {
    if (format.extension == extension) return format;
  }
  failFormat(path, extension, "expected .exr, .pfm, .hdr or .png");
}

// The largest decoded image in bytes.
uint64_t imageLimit() {
  const char* const variable = std::getenv(kImageLimitVariable);
  if (variable == nullptr || *variable == 0) return kImageLimit;
  constexpr std::string_view kUnits = "KMGT";
  std::string_view text(variable);
  const size_t unit = kUnits.find(text.back());
  if (unit != std::string_view::npos) text.remove_suffix(1);
  uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const unsigned shift = unit == std::string_view::npos ? 0 : 10 * static_cast<unsigned>(unit + 1);
  if (error != std::errc() || end != text.data() + text.size() || number == 0 || number > UINT64_MAX >> shift) {
    throw ImageError(kImageLimitVariable, "'" + std::string(variable) + "' is no size",
                     "expected bytes as a whole number, with K, M, G or T for powers of 1024");
  }
  return number << shift;
}

// Restores the light before it was multiplied by the exposure of each channel.
void undoExposure(const std::string& path, ImageFile& file) {
  if (file.exposure == ImageFile{}.exposure) return;
  for (const double factor : file.exposure) {
    if (factor > 0 && std::isfinite(factor)) continue;
    throw ImageError(path, "exposure in the header is not a number above 0",
                     "expected EXPOSURE= and a positive number, or COLORCORR= and three");
  }
  for (size_t i = 0; i < file.image.pixels.size(); ++i) {
    file.image.pixels[i] = static_cast<float>(file.image.pixels[i] / file.exposure[i % 3]);
  }
}

// The list of formats that can be written.
struct Writer {
  std::string_view extension;
  void (*write)(const std::string& path, const Image& linear, const Metadata& metadata, const WriteProgress& progress);
};
constexpr std::array kWriters{
    Writer{".exr", [](const std::string& path, const Image& image, const Metadata& metadata,
                      const WriteProgress& progress) { writeExr(path, image, metadata, {}, progress); }},
    Writer{".pfm", [](const std::string& path, const Image& image, const Metadata&,
                      const WriteProgress&) { writePfm(path, image); }},
    Writer{".png", [](const std::string& path, const Image& image, const Metadata&,
                      const WriteProgress&) { writePng(path, image); }},
};

// The writer for a path's extension. Throws ImageError where there is none.
const Writer& writerOf(const std::string& path) {
  const std::string extension = extensionOf(path);
  for (const Writer& writer : kWriters) {
    if (writer.extension == extension) return writer;
  }
  failFormat(path, extension, "expected .exr, .pfm or .png for writing");
}

}  // namespace

std::string extensionOf(const std::string& path) {
  const size_t dot = path.find_last_of("./");
  // A dot before the last slash belongs to a folder.
  if (dot == std::string::npos || path[dot] == '/') return {};
  std::string extension = path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void checkDecodedSize(const std::string& path, uint64_t width, uint64_t height, uint64_t fileBytes) {
  const uint64_t bytes = 3 * sizeof(float) * width * height, limit = imageLimit();
  if (bytes <= std::max(limit, kPlainRatio * fileBytes)) return;
  throw ImageError(path,
                   "file of " + std::to_string(fileBytes) + " bytes unpacks to " + std::to_string(width) + "x" +
                       std::to_string(height) + " pixels, " + std::to_string(bytes >> 20) + " MiB",
                   "expected at most " + std::to_string(limit >> 20) + " MiB; " + kImageLimitVariable + "=" +
                       std::to_string((bytes >> 30) + 1) + "G would read it");
}

ImageFile readImage(const std::string& path) {
  // An unknown extension is an error before the file is opened.
  const Format& format = formatOf(path, extensionOf(path));
  ImageFile file = format.decode(path, readFileBytes(path));
  if (!file.primaries.empty()) {
    throw ImageError(path, "colours of the primaries " + codecs::quoted(file.primaries),
                     "expected those of Rec. 709, or no PRIMARIES= in the header");
  }
  undoExposure(path, file);
  return file;
}

ImageFile decodeImage(const std::string& path, std::string_view extension, std::span<const unsigned char> bytes) {
  return formatOf(path, extension).decode(path, bytes);
}

Image readExrLayer(const std::string& path, const std::string& layer) {
  return codecs::decodeExrLayer(path, readFileBytes(path), layer);
}

void writePng(const std::string& path, const Image& linear) { writePng(path, encodeSrgb8(linear)); }

void checkImageTarget(const std::string& path) {
  // Only the error of an unknown extension matters here.
  writerOf(path);
  checkWritable(path);
}

void writeImage(const std::string& path, const Image& linear, const Metadata& metadata, const WriteProgress& progress) {
  writerOf(path).write(path, linear, metadata, progress);
}

namespace codecs {

void checkSize(const std::string& path, uint64_t width, uint64_t height, uint64_t leastBytes, uint64_t fileBytes) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width == 0 || height == 0) throw ImageError(path, "empty image (" + size + ")", "expected at least one pixel");
  // A product of the two sides might overflow.
  if (height > kMaxPixels / width) {
    throw ImageError(path, "image of " + size + " pixels",
                     "expected at most " + std::to_string(kMaxPixels) + " pixels");
  }
  if (leastBytes > fileBytes) {
    throw ImageError(path, "file of " + std::to_string(fileBytes) + " bytes ends before its " + size + " pixels",
                     "expected at least " + std::to_string(leastBytes) + " bytes");
  }
  if (fileBytes > 0) checkDecodedSize(path, width, height, fileBytes);
}

std::string quoted(const std::string& text) {
  constexpr size_t kLongest = 40;
  std::string result = "'" + text.substr(0, kLongest) + (text.size() > kLongest ? "...'" : "'");
  std::replace_if(
      result.begin(), result.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return result;
}

std::string HeaderReader::line() {
  // A damaged file without newlines must not become one long line.
  constexpr size_t kLongest = 4096;
  std::string text;
  while (!atEnd() && text.size() < kLongest) {
    const char c = static_cast<char>(bytes_[position_++]);
    if (c == '\n') break;
    text.push_back(c);
  }
  return text;
}

std::string HeaderReader::token() {
  std::string text;
  while (!atEnd() && std::isspace(bytes_[position_])) ++position_;
  // Tokens of valid headers are short, so a longer one is cut.
  while (!atEnd() && text.size() < 64) {
    const unsigned char c = bytes_[position_++];
    if (std::isspace(c)) {
      if (c == '\r' && !atEnd() && bytes_[position_] == '\n') ++position_;
      break;
    }
    text.push_back(static_cast<char>(c));
  }
  return text;
}

}  // namespace codecs
}  // namespace wavecrest
