// Radiance picture files (.hdr, RGBE): a text header, a resolution line, then scan lines of 4-byte pixels, either plain
// or run-length encoded per channel (the "new" encoding of Radiance 2; old-style runs of whole pixels are read too).
// A pixel (r, g, b, e) stands for (r, g, b) * 2^(e - 136), and black when e = 0 (Ward 1991, "Real Pixels").
// Only the usual orientation -Y H +X W is accepted, and only RGBE pixels, not XYZE.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "metrics/image/codecs.h"

namespace wavecrest::codecs {
namespace {

constexpr const char* kExpected = "expected a Radiance RGBE picture";

struct RadianceHeader {
  uint64_t width = 0, height = 0;
  // Product of all EXPOSURE= and COLORCORR= lines; 0 if one of them is no number.
  std::array<double, 3> exposure{1, 1, 1};
  std::string primaries{};  // as of ImageFile
};

// The numbers of a header line, each 0 from the first one on that is none.
template <size_t kCount>
std::array<double, kCount> numbersOf(const std::string& text) {
  std::istringstream in(text);
  std::array<double, kCount> numbers{};
  for (double& number : numbers) {
    if (!(in >> number)) number = 0;
  }
  return numbers;
}

// Whether PRIMARIES= names those of Rec. 709 or Radiance's own, which files in sRGB have by default.
bool isUsual(const std::string& primaries) {
  constexpr double kRounding = 1e-3;  // as for chromaticities of an EXR
  constexpr std::array<std::array<double, 8>, 2> kUsual{
      {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}, {0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 1. / 3, 1. / 3}}};
  const std::array<double, 8> own = numbersOf<8>(primaries);
  return std::any_of(kUsual.begin(), kUsual.end(), [&](const std::array<double, 8>& usual) {
    return std::equal(own.begin(), own.end(), usual.begin(),
                      [](double a, double b) { return std::abs(a - b) <= kRounding; });
  });
}

// The header up to the pixels. Throws ImageError for pixels that are not RGBE, and for other orientations.
RadianceHeader readHeader(const std::string& path, HeaderReader& reader) {
  if (reader.line().rfind("#?", 0) != 0) throw ImageError(path, "does not start with '#?'", kExpected);
  // Text lines up to an empty one. Lines of other variables are skipped.
  RadianceHeader header;
  for (;;) {
    if (reader.atEnd()) throw ImageError(path, "header has no end", kExpected);
    const std::string line = reader.line();
    if (line.empty()) break;
    if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe")
      throw ImageError(path, "pixel format " + quoted(line.substr(7)), "expected 32-bit_rle_rgbe");
    if (line.rfind("EXPOSURE=", 0) == 0) {
      const double factor = numbersOf<1>(line.substr(9))[0];
      for (double& exposure : header.exposure) exposure *= factor;
    }
    if (line.rfind("COLORCORR=", 0) == 0) {
      const std::array<double, 3> factors = numbersOf<3>(line.substr(10));
      for (size_t c = 0; c < 3; ++c) header.exposure[c] *= factors[c];
    }
    if (line.rfind("PRIMARIES=", 0) == 0) header.primaries = isUsual(line.substr(10)) ? "" : line.substr(10);
  }
  // The resolution line.
  std::istringstream resolution(reader.line());
  std::string yAxis, xAxis;
  int64_t height = 0, width = 0;
  if (!(resolution >> yAxis >> height >> xAxis >> width) || yAxis != "-Y" || xAxis != "+X" || width < 0 || height < 0)
    throw ImageError(path, "bad resolution line", "expected '-Y HEIGHT +X WIDTH'");
  header.width = static_cast<uint64_t>(width);
  header.height = static_cast<uint64_t>(height);
  return header;
}

// Decodes scan lines one by one from a byte cursor; every read is checked.
class ScanLines {
 public:
  ScanLines(const std::string& path, Bytes data, size_t width) : path_(path), data_(data), line_(width) {}

  using Pixel = std::array<unsigned char, 4>;

  // The next scan line, valid until the next call.
  const std::vector<Pixel>& next() {
    const size_t width = line_.size();
    // A scan line in the new encoding begins with 2, 2 and its width in two bytes. Only widths 8 to 32767 may have it.
    const bool newEncoding = width >= 8 && width < 32768 && remaining() >= 4 && at(0) == 2 && at(1) == 2 &&
                             (size_t{at(2)} << 8 | at(3)) == width;
    if (newEncoding) {
      position_ += 4;
      for (size_t channel = 0; channel < 4; ++channel) readChannel(channel);
    } else {
      readPlain();
    }
    return line_;
  }

 private:
  size_t remaining() const { return data_.size() - position_; }
  unsigned char at(size_t offset) const { return data_[position_ + offset]; }
  unsigned char take() {
    if (remaining() == 0) throw ImageError(path_, "file ends inside the pixels", kExpected);
    return data_[position_++];
  }
  [[noreturn]] void failRun() const { throw ImageError(path_, "a run passes the end of its scan line", kExpected); }

  // Runs of one channel: a count above 128 repeats one byte count - 128 times, others copy count bytes.
  void readChannel(size_t channel) {
    for (size_t x = 0; x < line_.size();) {
      size_t count = take();
      const bool repeat = count > 128;
      if (repeat) count -= 128;
      if (count == 0 || count > line_.size() - x) failRun();
      const unsigned char value = repeat ? take() : 0;
      for (size_t end = x + count; x < end; ++x) line_[x][channel] = repeat ? value : take();
    }
  }

  // Plain pixels; (1, 1, 1, n) repeats the pixel before it n times. The n of consecutive runs are the digits of one
  // count to base 256, the lowest first.
  void readPlain() {
    unsigned shift = 0;
    for (size_t x = 0; x < line_.size();) {
      Pixel pixel;
      for (unsigned char& byte : pixel) byte = take();
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        if (x == 0 || shift >= 32) failRun();
        const size_t count = size_t{pixel[3]} << shift;
        if (count > line_.size() - x) failRun();
        for (size_t end = x + count; x < end; ++x) line_[x] = line_[x - 1];
        shift += 8;
      } else {
        line_[x++] = pixel;
        shift = 0;
      }
    }
  }

  const std::string& path_;
  Bytes data_;
  size_t position_ = 0;
  std::vector<Pixel> line_;
};

}  // namespace

ImageFile decodeHdr(const std::string& path, Bytes bytes) {
  HeaderReader reader(bytes);
  const RadianceHeader header = readHeader(path, reader);
  checkSize(path, header.width, header.height, 0, 0);
  // The densest scan line is an old-style one of a pixel and a run, 8 bytes; no encoder reaches one byte for 16384
  // pixels.
  const uint64_t leastLines = header.height * std::min<uint64_t>(8, 4 * header.width);
  const uint64_t leastPixels = header.width * header.height / 16384;
  checkSize(path, header.width, header.height, std::max(leastLines, leastPixels), reader.rest().size());

  ImageFile file;
  file.image = {static_cast<uint32_t>(header.width), static_cast<uint32_t>(header.height), 3, {}};
  file.image.pixels.reserve(header.width * header.height * 3);
  file.exposure = header.exposure;
  file.primaries = header.primaries;
  ScanLines lines(path, reader.rest(), header.width);
  for (uint64_t y = 0; y < header.height; ++y) {
    for (const auto& [r, g, b, e] : lines.next()) {
      const double scale = e == 0 ? 0 : std::ldexp(1.0, int{e} - 136);
      for (unsigned char mantissa : {r, g, b}) file.image.pixels.push_back(static_cast<float>(mantissa * scale));
    }
  }
  return file;
}

}  // namespace wavecrest::codecs
