#include "metrics/hdrvdp2/model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "metrics/image/srgb.h"
#include "metrics/kernels/hdrvdp2_rows.h"

namespace wavecrest::vdp {
namespace {

// Value at x of the piecewise linear curve through (xs, ys), xs ascending; constant outside.
double interpolate(std::span<const double> xs, std::span<const double> ys, double x) {
  if (x <= xs.front()) return ys.front();
  if (x >= xs.back()) return ys.back();
  const auto i = static_cast<size_t>(std::upper_bound(xs.begin(), xs.end(), x) - xs.begin()) - 1;
  const double t = (x - xs[i]) / (xs[i + 1] - xs[i]);
  return ys[i] + t * (ys[i + 1] - ys[i]);
}

// Sensitivity of cones and rods together, and of rods alone, at a luminance c.
double jointSensitivity(double c) { return 30.162 * std::pow(std::pow(4.0627 / c, 1.6596) + 1, -0.2712); }
double rodSensitivity(double c) {
  const double d = std::abs(std::log10(c / 1.1732));
  const double fall = c > 1.1732 ? std::pow(d, 2.9899) / 0.5547 : std::pow(d, 1.2167) / 1.1478;
  return std::pow(10.0, 1.1414) * std::exp(-fall);
}

// kSensitivity times the integral of a sensitivity over the natural logarithm of luminance, by the trapezoidal rule.
// logLight is log10 of the luminance.
std::vector<double> integrate(std::span<const double> logLight, std::span<const double> sensitivity) {
  std::vector<double> integral(logLight.size(), 0.0);
  for (size_t i = 1; i < integral.size(); ++i) {
    const double step = (logLight[i] - logLight[i - 1]) * std::numbers::ln10;
    integral[i] = integral[i - 1] + kSensitivity * step * (sensitivity[i - 1] + sensitivity[i]) / 2;
  }
  return integral;
}

}  // namespace

double displayLight(uint8_t code) { return 99 * srgbDecodeTable()[code] + 1; }

double opticalTransfer(double rho) {
  // A sum of exponentials, whose weights sum to 1.
  constexpr std::array kWeights{0.4248385963012903, 0.5724351039364803, 0.00016757623916493702, 0.0025587235230643303};
  constexpr std::array kWidths{0.028, 0.37, 37.0, 360.0};  // degrees
  double sum = 0;
  for (size_t i = 0; i < kWeights.size(); ++i) sum += kWeights[i] * std::exp(-kWidths[i] * rho);
  return sum;
}

ResponseTables makeResponseTables() {
  // Sensitivity of rods, and of cones as what rods leave of the joint sensitivity.
  std::vector<double> logLight(kVdpLightNodes), light(kVdpLightNodes), cones(kVdpLightNodes), rods(kVdpLightNodes);
  for (size_t i = 0; i < kVdpLightNodes; ++i) {
    logLight[i] = -5 + 10 * static_cast<double>(i) / (kVdpLightNodes - 1);
    light[i] = std::pow(10.0, logLight[i]);
    rods[i] = rodSensitivity(light[i]);
    cones[i] = std::max(jointSensitivity(light[i]) - rods[i], 0.001);
  }
  // L and M cones share what the rods leave; each sees about half of the luminance.
  std::vector<double> eachCone(kVdpLightNodes);
  for (size_t i = 0; i < kVdpLightNodes; ++i)
    eachCone[i] = 0.5 * interpolate(light, cones, std::min(2 * light[i], light.back()));
  return {integrate(logLight, eachCone), integrate(logLight, rods)};
}

double contrastSensitivity(double frequency, double luminance) {
  if (frequency == 0) return 0;
  // Parameters at six adapting luminances, interpolated over the logarithm of luminance. p1 and p2 shape the fall
  // towards high frequencies, p3 the fall towards low ones. p4 scales the whole.
  static const std::array kLogLuminance{std::log10(0.002), std::log10(0.02), std::log10(0.2),
                                        std::log10(2.0),   std::log10(20.0), std::log10(150.0)};
  constexpr std::array kP1{0.991265, 0.800889, 0.476505, 0.405782, 0.334278, 0.394533};
  constexpr std::array kP2{3.74038, 3.54104, 4.37453, 4.40602, 3.79542, 2.7755};
  constexpr std::array kP3{0.50722, 0.682505, 0.750315, 0.935314, 1.07327, 1.16577};
  constexpr std::array kP4{4.46044, 4.94958, 5.28678, 5.61425, 6.4635, 7.45665};
  const double z = std::log10(luminance);
  const double p1 = interpolate(kLogLuminance, kP1, z), p2 = interpolate(kLogLuminance, kP2, z);
  const double p3 = interpolate(kLogLuminance, kP3, z), p4 = interpolate(kLogLuminance, kP4, z);
  const double low = 1 - std::exp(-(frequency / 7) * (frequency / 7));
  return p4 / std::sqrt((1 + std::pow(p1 * frequency, p2)) / std::pow(low, p3));
}

double bandWeight(double frequency) {
  // Weights at seven band frequencies, linear in between and constant outside.
  constexpr std::array kFrequency{0.2344, 0.4688, 0.9375, 1.875, 3.75, 7.5, 15.0};
  constexpr std::array kWeight{0.0002, 0.0003, 0.0003, 0.0398, 0.2690, 0.2142, 0.2832};
  return interpolate(kFrequency, kWeight, frequency);
}

double meanOpinionScore(double q) { return 100 / (1 + std::exp(3.455 * (q + 0.8886))); }

}  // namespace wavecrest::vdp
