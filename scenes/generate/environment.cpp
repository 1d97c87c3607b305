#include "scenes/generate/environment.h"

#include <algorithm>
#include <numbers>

namespace wavecrest::generate {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Vec3 kZenith{0.10, 0.17, 0.34}, kHorizon{0.34, 0.36, 0.40}, kBelow{0.10, 0.09, 0.08};

// A Gaussian lobe of sigma s (radians) and peak P gives an irradiance of about 2 pi P s^2. Its width sets the blur of
// the caustics; the sun stands behind the dragon and to its left, so that they fall in front of it.
constexpr double kSunElevation = 40 * kDegree, kSunAzimuth = -142 * kDegree, kSunSigma = 4 * kDegree;
constexpr Vec3 kSunPeak{120, 111.6, 96};

Vec3 skyRadiance(const Vec3& direction, const Vec3& sun) {
  Vec3 radiance = kBelow;
  if (direction[1] > 0) {
    const double t = std::sqrt(direction[1]);
    radiance = (1 - t) * kHorizon + t * kZenith;
  }
  const double angle = std::acos(std::clamp(dot(direction, sun), -1.0, 1.0));
  return radiance + std::exp(-0.5 * (angle / kSunSigma) * (angle / kSunSigma)) * kSunPeak;
}

}  // namespace

Image makeSky() {
  const Vec3 sun{std::sin(kSunAzimuth) * std::cos(kSunElevation), std::sin(kSunElevation),
                 std::cos(kSunAzimuth) * std::cos(kSunElevation)};
  Image image(512, 256);
  for (uint32_t j = 0; j < image.height; ++j) {
    const double theta = std::numbers::pi * (j + 0.5) / image.height;
    for (uint32_t i = 0; i < image.width; ++i) {
      const double phi = 2 * std::numbers::pi * (i + 0.5) / image.width;
      const Vec3 direction{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
      image.at(i, j) = skyRadiance(direction, sun);
    }
  }
  return image;
}

}  // namespace wavecrest::generate
