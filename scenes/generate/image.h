// A small linear RGB picture and its two file forms: 8-bit sRGB PNG for textures, 32-bit float EXR for radiance.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scenes/generate/vec3.h"

namespace wavecrest::generate {

struct Image {
  uint32_t width = 0, height = 0;
  std::vector<Vec3> pixels;  // linear Rec.709, row-major from the top

  Image(uint32_t w, uint32_t h) : width(w), height(h), pixels(size_t{w} * h) {}
  Vec3& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
  const Vec3& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

// 8 bit, clamped to [0, 1]. Colours are encoded with the sRGB curve, which is what readers of a PNG assume; data such
// as normals are stored raw. Both functions throw std::runtime_error when the file cannot be written.
enum class PngEncoding { srgb, raw };
void writePng(const Image& image, const std::filesystem::path& file, PngEncoding encoding = PngEncoding::srgb);
void writeExr(const Image& image, const std::filesystem::path& file);

}  // namespace wavecrest::generate
