#include "scenes/generate/image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <stdexcept>

#include "scenes/generate/atomic_file.h"

namespace wavecrest::generate {
namespace {

uint8_t encode(double linear, PngEncoding encoding) {
  double x = std::clamp(linear, 0.0, 1.0);
  // IEC 61966-2-1
  if (encoding == PngEncoding::srgb) x = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255 * x));
}

}  // namespace

void writePng(const Image& image, const std::filesystem::path& file, PngEncoding encoding) {
  std::vector<uint8_t> bytes;
  for (const Vec3& pixel : image.pixels)
    for (double value : pixel) bytes.push_back(encode(value, encoding));
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = PNG_FORMAT_RGB;
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    if (!png_image_write_to_file(&png, temporary.c_str(), 0, bytes.data(), 0, nullptr)) {
      throw std::runtime_error("cannot write " + file.string() + ": " + png.message);
    }
  });
}

void writeExr(const Image& image, const std::filesystem::path& file) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  const char* names[3] = {"R", "G", "B"};
  std::vector<float> planes[3];
  for (size_t channel = 0; channel < 3; ++channel) {
    for (const Vec3& pixel : image.pixels) planes[channel].push_back(static_cast<float>(pixel[channel]));
    header.channels().insert(names[channel], Imf::Channel(Imf::FLOAT));
    frame.insert(names[channel], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[channel].data()), sizeof(float),
                                            image.width * sizeof(float)));
  }
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    Imf::OutputFile out(temporary.c_str(), header, 0);  // no threads
    out.setFrameBuffer(frame);
    out.writePixels(static_cast<int>(image.height));
  });
}

}  // namespace wavecrest::generate
