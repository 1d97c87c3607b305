// The golden image pairs and the figures that reference implementations gave for them (tests/metrics/golden; each JSON
// file states in its head how it was made).
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest::test {

inline std::string goldenPath(const std::string& name) { return std::string(WAVECREST_GOLDEN_DIR) + "/" + name; }

inline Image8 codesOf(const Image& image) {
  Image8 codes{image.width, image.height, {}};
  for (float v : image.pixels) codes.pixels.push_back(static_cast<uint8_t>(std::lround(v * 255.0f)));
  return codes;
}

inline Image8 readCodes(const std::string& path) { return codesOf(readImage(path).image); }

struct GoldenPair {
  std::string name;
  Image8 reference, test;
};

// All of them; under sanitizers without the largest.
const std::vector<GoldenPair>& goldenPairs();

// A figure of one pair in one golden file: a number, or one of a list.
double goldenFigure(const std::string& file, const std::string& pair, const std::string& figure);
double goldenFigure(const std::string& file, const std::string& pair, const std::string& figure, size_t index);

inline Image toFloats(const Image8& codes) {
  Image image{codes.width, codes.height, 3, {}};
  for (uint8_t c : codes.pixels) image.pixels.push_back(static_cast<float>(c) / 255.0f);
  return image;
}

// Linear light of codes, rounded to floats.
inline Image lightOf(const Image8& codes) {
  Image light{codes.width, codes.height, 3, {}};
  for (const uint8_t code : codes.pixels) light.pixels.push_back(static_cast<float>(srgbDecodeTable()[code]));
  return light;
}

// A picture with structure at all scales: gradients, edges and a little texture. Any size.
inline Image8 patternImage(uint32_t width, uint32_t height) {
  Image8 image{width, height, {}};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const uint32_t checker = (x / 7 + y / 5) % 2 * 60;
      image.pixels.push_back(static_cast<uint8_t>(x * 150 / width + checker));
      image.pixels.push_back(static_cast<uint8_t>(y * 150 / height + checker + (x * y) % 17));
      image.pixels.push_back(static_cast<uint8_t>(40 + checker + (x + 2 * y) % 23));
    }
  }
  return image;
}

// The image plus noise of the given amplitude, the same pattern for every amplitude.
inline Image8 withNoise(const Image8& image, int amplitude) {
  Image8 noisy = image;
  uint32_t state = 12345;
  for (uint8_t& code : noisy.pixels) {
    state = state * 1664525u + 1013904223u;
    const int noise = static_cast<int>(state >> 16) % (2 * 1000 + 1) - 1000;
    code = static_cast<uint8_t>(std::clamp(code + noise * amplitude / 1000, 0, 255));
  }
  return noisy;
}

}  // namespace wavecrest::test
