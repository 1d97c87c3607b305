#include "metrics/image/exr_colour.h"

#include <ImathMatrix.h>
#include <ImathVec.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfRgbaYca.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace wavecrest::codecs {

namespace {

// The primaries of the file, which are Rec. 709's where the header gives none.
Imf::Chromaticities chromaticitiesOf(const Imf::Header& header) {
  return Imf::hasChromaticities(header) ? Imf::chromaticities(header) : Imf::Chromaticities();
}

// Whether two sets of primaries are the same but for the digits that files leave out.
bool isNearly(const Imf::Chromaticities& a, const Imf::Chromaticities& b) {
  constexpr float kRounding = 1e-3f;
  const auto close = [](const Imath::V2f& p, const Imath::V2f& q) { return p.equalWithAbsError(q, kRounding); };
  return close(a.red, b.red) && close(a.green, b.green) && close(a.blue, b.blue) && close(a.white, b.white);
}

// From the file's RGB or from XYZ to Rec. 709, for row vectors; nothing where they are the same.
std::optional<Imath::M44f> toRec709(const std::string& path, const Imf::Header& header, ExrColour colour) {
  const Imf::Chromaticities own = chromaticitiesOf(header), rec709;
  if (colour == ExrColour::xyz) {
    // Mitsuba's, which are those of the specification to six digits.
    return Imath::M44f(3.240479f, -0.969256f, 0.055648f, 0, -1.537150f, 1.875991f, -0.204043f, 0, -0.498535f, 0.041556f,
                       1.057311f, 0, 0, 0, 0, 1);
  }
  if (isNearly(own, rec709)) return std::nullopt;
  const auto fail = [&] {
    throw ImageError(path, "chromaticities in the header span no colours",
                     "expected three primaries and a white point");
  };
  Imath::M44f matrix;
  try {
    matrix = Imf::RGBtoXYZ(own, 1) * Imf::XYZtoRGB(rec709, 1);
  } catch (const std::exception&) {
    fail();
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!std::isfinite(matrix[i][j])) fail();
    }
  }
  return matrix;
}

// Y RY BY to RGB with the primaries of the file.
void undoLumaChroma(const Imf::Header& header, Image& image) {
  const Imath::V3f yw = Imf::RgbaYca::computeYw(chromaticitiesOf(header));
  for (size_t i = 0; i < image.pixels.size(); i += 3) {
    float* const p = &image.pixels[i];
    const float y = p[0], r = (p[1] + 1) * y, b = (p[2] + 1) * y;
    p[0] = r;
    p[1] = (y - r * yw.x - b * yw.z) / yw.y;
    p[2] = b;
  }
}

}  // namespace

ExrChannels findExrChannels(const Imf::ChannelList& channels, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const ExrChannels kinds[] = {{ExrColour::rgb, {"R", "G", "B"}},
                               {ExrColour::xyz, {"X", "Y", "Z"}},
                               {ExrColour::lumaChroma, {"Y", "RY", "BY"}},
                               {ExrColour::luminance, {"Y"}}};
  for (const ExrChannels& kind : kinds) {
    ExrChannels found{kind.colour, {}};
    for (const std::string& name : kind.names)
      if (channels.findChannel((prefix + name).c_str())) found.names.push_back(prefix + name);
    if (found.names.size() == kind.names.size()) return found;
  }
  return {};
}

ExrChannelTarget::ExrChannelTarget(const Imf::Channel& channel, Image& image, size_t column)
    : image_(image),
      column_(column),
      stepX_(static_cast<uint32_t>(std::max(1, channel.xSampling))),
      stepY_(static_cast<uint32_t>(std::max(1, channel.ySampling))) {
  if (!isSubsampled()) return;
  width_ = (image.width + stepX_ - 1) / stepX_;
  height_ = (image.height + stepY_ - 1) / stepY_;
  samples_.resize(size_t{width_} * height_);
}

Imf::Slice ExrChannelTarget::slice(const Imath::Box2i& window) {
  const bool own = isSubsampled();
  // OpenEXR addresses pixels by their absolute position in the data window.
  char* const base = reinterpret_cast<char*>(own ? samples_.data() : image_.pixels.data() + column_);
  const size_t xStride = (own ? 1 : 3) * sizeof(float), yStride = xStride * (own ? width_ : image_.width);
  return Imf::Slice::Make(Imf::FLOAT, base, window.min, int64_t{image_.width}, int64_t{image_.height}, xStride, yStride,
                          static_cast<int>(stepX_), static_cast<int>(stepY_));
}

void ExrChannelTarget::spread() const {
  if (!isSubsampled()) return;
  for (uint32_t y = 0; y < image_.height; ++y) {
    for (uint32_t x = 0; x < image_.width; ++x) {
      const uint32_t x0 = x / stepX_, y0 = y / stepY_;
      const uint32_t x1 = std::min(x0 + 1, width_ - 1), y1 = std::min(y0 + 1, height_ - 1);
      const float u = static_cast<float>(x % stepX_) / static_cast<float>(stepX_);
      const float v = static_cast<float>(y % stepY_) / static_cast<float>(stepY_);
      const auto row = [&](uint32_t r) { return (1 - u) * at(x0, r) + u * at(x1, r); };
      image_.pixels[(size_t{y} * image_.width + x) * 3 + column_] = (1 - v) * row(y0) + v * row(y1);
    }
  }
}

void convertExrColour(const std::string& path, const Imf::Header& header, ExrColour colour, Image& image) {
  if (colour == ExrColour::luminance) {
    for (size_t i = 0; i < image.pixels.size(); i += 3) image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];
    return;
  }
  if (colour == ExrColour::lumaChroma) undoLumaChroma(header, image);
  const std::optional<Imath::M44f> matrix = toRec709(path, header, colour);
  if (!matrix) return;
  const Imath::M44f& m = *matrix;
  for (size_t i = 0; i < image.pixels.size(); i += 3) {
    float* const p = &image.pixels[i];
    const float x = p[0], y = p[1], z = p[2];
    for (int c = 0; c < 3; ++c) p[c] = x * m[0][c] + y * m[1][c] + z * m[2][c];
  }
}

// A file begins with 8 bytes; an attribute is its name, its type, its size in 4 bytes, and its value. An empty name
// ends a header; in files of several parts an empty header ends the list of them.
void checkExrHeader(const std::string& path, Bytes bytes) {
  constexpr size_t kMagic = 8;
  constexpr unsigned char kMultipartFlag = 0x10;  // in the second byte of the version
  if (bytes.size() < kMagic) return;              // OpenEXR has a message for that
  const bool multipart = (bytes[5] & kMultipartFlag) != 0;
  size_t at = kMagic;
  // Skips a string and its end. Returns its length.
  const auto skipString = [&] {
    const auto end = std::find(bytes.begin() + static_cast<ptrdiff_t>(at), bytes.end(), 0);
    const size_t begin = at, length = static_cast<size_t>(end - bytes.begin()) - begin;
    at = std::min(bytes.size(), begin + length + 1);
    return length;
  };
  for (bool headerIsEmpty = true; at < bytes.size();) {
    if (skipString() == 0) {
      if (!multipart || headerIsEmpty) return;
      headerIsEmpty = true;
      continue;
    }
    headerIsEmpty = false;
    skipString();
    uint32_t size = 0;
    if (bytes.size() - at < sizeof size) return;
    std::memcpy(&size, bytes.data() + at, sizeof size);
    at += sizeof size;
    if (size > bytes.size() - at) {
      throw ImageError(
          path,
          "an attribute of " + std::to_string(size) + " bytes in a file of " + std::to_string(bytes.size()) + " bytes",
          "expected an intact EXR file");
    }
    at += size;
  }
}

}  // namespace wavecrest::codecs
