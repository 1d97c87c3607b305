#include "engine/compile/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/compile/sky_tables.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {

namespace {

// An odd number of rows has one on the horizon. Texels are 0.7 degrees wide and 0.09 degrees high: near the horizon
// the sky changes within half a degree, and rows of 0.35 degrees left it 0.5 % too dark there.
constexpr uint32_t kWidth = 512, kHeight = 2049, kHorizon = kHeight / 2;

// A place between two entries of a table at 0, 1, ..., size - 1: the entry before `at`, and the share of the entry
// after. Beyond the table, the place is at its end.
struct Place {
  size_t index;
  double share;
};
Place placeIn(size_t size, double at) {
  const double clamped = std::clamp(at, 0.0, static_cast<double>(size - 1));
  const size_t index = std::min(static_cast<size_t>(clamped), size - 2);
  return {index, clamped - static_cast<double>(index)};
}

void addScaled(SkyCoefficients& sum, double factor, const SkyCoefficients& term) {
  sum.radiance += factor * term.radiance;
  for (size_t i = 0; i < std::size(sum.shape); ++i) sum.shape[i] += factor * term.shape[i];
}

// One channel for given conditions: linear in turbidity and albedo, a Bezier curve of degree 5 in the cube root of the
// sun's elevation over a right angle.
SkyCoefficients coefficientsOf(double turbidity, double albedo, double sunElevation, size_t channel) {
  constexpr double kBinomial[kSkyControls] = {1, 5, 10, 10, 5, 1};
  const double x = std::clamp(std::cbrt(2 * sunElevation * std::numbers::inv_pi), 0.0, 1.0);
  const Place place = placeIn(kSkyTurbidities, turbidity - 1);
  SkyCoefficients sum{};
  for (size_t control = 0; control < kSkyControls; ++control) {
    const double weight = kBinomial[control] * std::pow(x, control) * std::pow(1 - x, kSkyControls - 1 - control);
    for (const size_t step : {size_t{0}, size_t{1}}) {
      const auto& table = kSkyCoefficients[place.index + step];
      const double share = weight * (step == 0 ? 1 - place.share : place.share);
      addScaled(sum, share * (1 - albedo), table[0][control][channel]);
      addScaled(sum, share * albedo, table[1][control][channel]);
    }
  }
  return sum;
}

// Hosek and Wilkie 2012, equations 8 and 9.
double radianceOf(const SkyCoefficients& sky, double cosTheta, double sunAngle) {
  // The data set stores the factor of the root, I in the paper, before the parameter of the glow, H.
  const auto& [a, b, c, d, e, f, g, h, i] = sky.shape;
  const double cosine = std::cos(sunAngle), cosine2 = cosine * cosine;
  const double glow = (1 + cosine2) / std::pow(1 + i * i - 2 * i * cosine, 1.5);
  const double gradient = 1 + a * std::exp(b / (cosTheta + 0.01));
  const double around =
      c + d * std::exp(e * sunAngle) + f * cosine2 + g * glow + h * std::sqrt(std::max(cosTheta, 0.0));
  return std::max(gradient * around * sky.radiance / kSkyUnit, 0.0);
}

// The sky without the sun, in the frame of the map. Rows go from the zenith to the horizon; the row below repeats the
// horizon, because interpolation between rows reaches it. All others below are black.
std::shared_ptr<const Bitmap> bakeSky(const SunskyEmitter& emitter, double sunElevation, const Double3& sun) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = kWidth;
  bitmap->height = kHeight;
  bitmap->pixels.resize(size_t{3} * kWidth * kHeight);
  // Coefficients of the channels.
  std::array<SkyCoefficients, 3> channels{};
  for (size_t c = 0; c < 3; ++c) {
    channels[c] = coefficientsOf(emitter.turbidity, emitter.albedo[c], sunElevation, c);
  }
  // Radiance of each texel. The angle from the sun comes from a chord, which is accurate close to the sun.
  for (uint32_t row = 0; row <= kHorizon; ++row) {
    const double theta = std::numbers::pi * row / (kHeight - 1);
    const double sinTheta = std::sin(theta), cosTheta = row == kHorizon ? 0 : std::cos(theta);
    for (uint32_t column = 0; column < kWidth; ++column) {
      const double phi = 2 * std::numbers::pi * (column + 0.5) / kWidth;
      const Double3 direction{std::sin(phi) * sinTheta, cosTheta, -std::cos(phi) * sinTheta};
      const double sunAngle = 2 * std::asin(std::min(0.5 * length(direction - sun), 1.0));
      for (size_t c = 0; c < 3; ++c) {
        bitmap->pixels[3 * (size_t{row} * kWidth + column) + c] =
            static_cast<float>(emitter.skyScale * radianceOf(channels[c], cosTheta, sunAngle));
      }
    }
  }
  const auto horizon = bitmap->pixels.begin() + std::ptrdiff_t{3} * kHorizon * kWidth;
  std::copy_n(horizon, 3 * kWidth, horizon + 3 * kWidth);
  return bitmap;
}

// Adds the sun's disc, and the share of samples that goes to it: that of its light, but at least a tenth for each of
// sun and sky, and all for the sun without a sky.
void addSun(const SunskyEmitter& emitter, const Double3& towardsSun, double sunElevation, Environment& out) {
  const Rgb irradiance = emitter.sunScale * sunIrradiance(emitter.turbidity, sunElevation);
  const double ofSky = 4 * std::numbers::pi * out.meanLuminance, ofSun = luminance(irradiance);
  if (!(ofSun > 0)) return;
  // Half the chord from the disc's middle to its rim. The solid angle, 2 pi (1 - cos), is pi times the squared chord.
  const double halfChord = std::sin(0.25 * emitter.sunAperture * std::numbers::pi / 180);
  EnvironmentView& view = out.view;
  view.sunChord2 = 4 * halfChord * halfChord;
  view.sunShare = ofSky > 0 ? static_cast<float>(std::clamp(ofSun / (ofSun + ofSky), 0.1, 0.9)) : 1.0f;
  for (size_t i = 0; i < 3; ++i) {
    view.sunDirection[i] = towardsSun[i];
    view.sunRadiance[i] = irradiance[i] / (std::numbers::pi * view.sunChord2);
  }
  out.meanLuminance += ofSun / (4 * std::numbers::pi);
}

}  // namespace

Rgb skyRadiance(double turbidity, const Rgb& albedo, double sunElevation, double cosTheta, double sunAngle) {
  Rgb out{};
  for (size_t c = 0; c < 3; ++c) {
    out[c] = radianceOf(coefficientsOf(turbidity, albedo[c], sunElevation, c), cosTheta, sunAngle);
  }
  return out;
}

Rgb sunIrradiance(double turbidity, double sunElevation) {
  // Bilinear in turbidity and elevation, whose columns are 3 degrees apart from 2 degrees on.
  const Place row = placeIn(kSkyTurbidities, turbidity - 1);
  const Place column = placeIn(kSunElevations, (sunElevation * 180 / std::numbers::pi - 2) / 3);
  Rgb out{};
  for (const size_t i : {size_t{0}, size_t{1}}) {
    for (const size_t j : {size_t{0}, size_t{1}}) {
      const double weight = (i == 0 ? 1 - row.share : row.share) * (j == 0 ? 1 - column.share : column.share);
      for (size_t c = 0; c < 3; ++c) out[c] += weight * kSunIrradiance[row.index + i][column.index + j][c];
    }
  }
  return out;
}

Environment compileSky(const SunskyEmitter& emitter) {
  const auto axis = [&](size_t i) {
    const Matrix4& m = emitter.toWorld;
    return normalized({m[0][i], m[1][i], m[2][i]});
  };
  // The sky's zenith is its z axis, the map's is y.
  const Double3 x = axis(0), up = axis(2), z = -1.0 * axis(1);
  EnvmapEmitter map;
  for (size_t i = 0; i < 3; ++i) map.toWorld[i] = {x[i], up[i], z[i], 0};
  map.toWorld[3] = {0, 0, 0, 1};
  const Double3 sun = emitter.sunDirection, local{dot(sun, x), dot(sun, up), dot(sun, z)};
  const double elevation = std::asin(std::clamp(local[1], -1.0, 1.0));
  // A sun below the horizon: one black texel.
  if (elevation < 0) {
    map.bitmap = std::make_shared<Bitmap>(Bitmap{.width = 1, .height = 1, .pixels = {0, 0, 0}});
    return compileEnvironment(map);
  }
  map.bitmap = bakeSky(emitter, elevation, local);
  Environment out = compileEnvironment(map);
  addSun(emitter, sun, elevation, out);
  out.view.isSky = true;
  return out;
}

}  // namespace wavecrest
