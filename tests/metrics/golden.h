// The golden image pairs and the figures that reference implementations gave for them (tests/metrics/golden; each JSON
// file states in its head how it was made).
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest::test {

inline std::string goldenPath(const std::string& name) { return std::string(WAVECREST_GOLDEN_DIR) + "/" + name; }

inline nlohmann::json goldenJson(const std::string& name) {
  std::ifstream stream(goldenPath(name));
  return nlohmann::json::parse(stream);
}

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

inline const std::vector<GoldenPair>& goldenPairs() {
  static const std::vector<GoldenPair> pairs = [] {
    std::vector<GoldenPair> list;
    const auto figures = goldenJson("rmse.json");
    for (const auto& entry : figures["pairs"]) {
      const std::string name = entry["pair"];
      list.push_back({name, readCodes(goldenPath(name + "_ref.png")), readCodes(goldenPath(name + "_test.png"))});
    }
    return list;
  }();
  return pairs;
}

// The figures of one pair in one golden file.
inline nlohmann::json goldenFigures(const std::string& file, const std::string& pair) {
  const auto figures = goldenJson(file);
  for (const auto& entry : figures["pairs"])
    if (entry["pair"] == pair) return entry;
  throw std::runtime_error("no golden figures for " + pair);
}

inline Image toFloats(const Image8& codes) {
  Image image{codes.width, codes.height, 3, {}};
  for (uint8_t c : codes.pixels) image.pixels.push_back(static_cast<float>(c) / 255.0f);
  return image;
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
