#include "scenes/generate/environment.h"

#include <algorithm>
#include <numbers>

namespace wavecrest::generate {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Vec3 kZenith{0.10, 0.17, 0.34}, kHorizon{0.34, 0.36, 0.40}, kBelow{0.10, 0.09, 0.08};

// A Gaussian lobe of sigma s (radians) and peak P gives an irradiance of about 2 pi P s^2. Its width sets the blur of
// the caustics; the sun stands behind the dragon and to its left, so that they fall in front of it.
constexpr double kSunElevation = 40 * kDegree, kSunAzimuth = -142 * kDegree;
constexpr Vec3 kSunPeak{120, 111.6, 96};  // of the wide one

Vec3 skyRadiance(const Vec3& direction, const Vec3& sun, double sigma) {
  Vec3 radiance = kBelow;
  if (direction[1] > 0) {
    const double t = std::sqrt(direction[1]);
    radiance = (1 - t) * kHorizon + t * kZenith;
  }
  const double angle = std::acos(std::clamp(dot(direction, sun), -1.0, 1.0));
  const double narrower = kWideSun.degrees * kDegree / sigma;
  return radiance + narrower * narrower * std::exp(-0.5 * (angle / sigma) * (angle / sigma)) * kSunPeak;
}

}  // namespace

Image makeSky(const SunWidth& width) {
  const Vec3 sun{std::sin(kSunAzimuth) * std::cos(kSunElevation), std::sin(kSunElevation),
                 std::cos(kSunAzimuth) * std::cos(kSunElevation)};
  Image image(2 * width.rows, width.rows);
  const double step = 1.0 / width.samples;
  for (uint32_t j = 0; j < image.height; ++j) {
    for (uint32_t i = 0; i < image.width; ++i) {
      Vec3 sum{};
      for (uint32_t k = 0; k < width.samples * width.samples; ++k) {
        const uint32_t row = k / width.samples, column = k % width.samples;
        const double x = i + (column + 0.5) * step, y = j + (row + 0.5) * step;
        const double theta = std::numbers::pi * y / image.height, phi = 2 * std::numbers::pi * x / image.width;
        const Vec3 direction{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
        sum = sum + skyRadiance(direction, sun, width.degrees * kDegree);
      }
      image.at(i, j) = (step * step) * sum;
    }
  }
  return image;
}

}  // namespace wavecrest::generate
