#include "scenes/generate/pictures.h"

#include <algorithm>
#include <numbers>

namespace wavecrest::generate {
namespace {

// A number in [0, 1) that depends on the cell and the seed only (the finaliser of MurmurHash3).
double cellNoise(int x, int y, uint32_t seed) {
  uint32_t h = seed * 0x9e3779b9u ^ static_cast<uint32_t>(x) * 0x85ebca6bu ^ static_cast<uint32_t>(y) * 0xc2b2ae35u;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h ^= h >> 16;
  return h / 4294967296.0;
}

// Value noise: cell values blended by a smoothstep.
double smoothNoise(double x, double y, uint32_t seed) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const double fx = x - i, fy = y - j;
  const double sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
  return std::lerp(std::lerp(cellNoise(i, j, seed), cellNoise(i + 1, j, seed), sx),
                   std::lerp(cellNoise(i, j + 1, seed), cellNoise(i + 1, j + 1, seed), sx), sy);
}

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return (1 - t) * a + t * b; }

// Height of a range of hills over the width of the picture: three octaves, the first of `hills` humps.
double ridge(double x, double hills, uint32_t seed) {
  return smoothNoise(hills * x, 0, seed) + 0.4 * smoothNoise(2.7 * hills * x, 1, seed) +
         0.15 * smoothNoise(7 * hills * x, 2, seed);
}

}  // namespace

Image makeTiles() {
  constexpr uint32_t kTile = 32, kJoint = 2;
  constexpr Vec3 kGlaze{0.214, 0.477, 0.604}, kGrout{0.522, 0.522, 0.479};
  Image image(256, 256);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const bool joint = x % kTile < kJoint || y % kTile < kJoint;
      const double tone = 0.76 + 0.43 * cellNoise(static_cast<int>(x / kTile), static_cast<int>(y / kTile), 1);
      image.at(x, y) = joint ? kGrout : tone * kGlaze;
    }
  }
  return image;
}

Image makeWood() {
  constexpr Vec3 kLight{0.60, 0.27, 0.10}, kDark{0.34, 0.115, 0.035};
  Image image(256, 512);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const double u = (x + 0.5) / image.width, v = (y + 0.5) / image.height;
      // Growth rings, bent by slow noise along the grain, and fine fibres.
      const double bend = 1.6 * smoothNoise(3 * u, 1.5 * v, 2) + 0.5 * smoothNoise(9 * u, 4 * v, 3);
      const double ring = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (5 * u + 2 * bend));
      const double fibre = smoothNoise(120 * u, 8 * v, 4);
      image.at(x, y) = mix(kLight, kDark, std::clamp(0.55 * ring * ring + 0.3 * fibre, 0.0, 1.0));
    }
  }
  return image;
}

Image makeLandscape() {
  constexpr Vec3 kSkyTop{0.10, 0.26, 0.55}, kSkyLow{0.85, 0.62, 0.38}, kSun{1.0, 0.90, 0.62};
  constexpr Vec3 kFar{0.34, 0.36, 0.45}, kNear{0.035, 0.10, 0.03};
  constexpr int kRanges = 5;
  Image image(512, 256);
  for (uint32_t py = 0; py < image.height; ++py) {
    for (uint32_t px = 0; px < image.width; ++px) {
      const double x = 2 * (px + 0.5) / image.width, y = 1 - (py + 0.5) / image.height;  // x 0 .. 2, y up 0 .. 1
      Vec3 color = mix(kSkyLow, kSkyTop, std::clamp((y - 0.4) / 0.6, 0.0, 1.0));
      const double sunDistance = std::hypot(x - 1.45, y - 0.66);
      color = mix(color, kSun, sunDistance < 0.055 ? 1.0 : 0.5 * std::exp(-9 * sunDistance));
      for (int range = 0; range < kRanges; ++range) {  // far to near: lower, rougher, darker
        const double depth = range / (kRanges - 1.0);
        const double crest = 0.50 - 0.42 * depth + 0.16 * ridge(x, 1.5 + range, 10u + static_cast<uint32_t>(range));
        if (y < crest) color = (0.85 + 0.15 * smoothNoise(60 * x, 60 * y, 20)) * mix(kFar, kNear, depth);
      }
      image.at(px, py) = color;
    }
  }
  return image;
}

Image makeBumps() {
  Image image(64, 64);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const double u = 4 * (x + 0.5) / image.width, v = 4 * (y + 0.5) / image.height;
      const double height = std::pow(std::sin(std::numbers::pi * u) * std::sin(std::numbers::pi * v), 2);
      image.at(x, y) = {height, height, height};
    }
  }
  return image;
}

Image makeNormals() {
  Image image(64, 64);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const double u = 2 * std::numbers::pi * (x + 0.5) / image.width,
                   v = 2 * std::numbers::pi * (y + 0.5) / image.height;
      const Vec3 normal = normalize({0.35 * std::cos(3 * u), 0.25 * std::cos(2 * v), 1});
      image.at(x, y) = 0.5 * (normal + Vec3{1, 1, 1});
    }
  }
  return image;
}

Image makePatches() {
  Image image(8, 6);
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      for (uint32_t channel = 0; channel < 3; ++channel)
        image.at(x, y)[channel] = 0.1 + 0.8 * cellNoise(static_cast<int>(x), static_cast<int>(y), 30 + channel);
    }
  }
  return image;
}

}  // namespace wavecrest::generate
