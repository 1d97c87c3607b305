// The constants of ColorVideoVDP 0.5.7 for still images on its display "standard_4k", and what follows from them.
//
// Mantiuk, Hanji, Ashraf, Asano, Chapiro, "ColorVideoVDP: A visual difference predictor for image, video and display
// distortions", ACM TOG 43(4), 2024; parameters of the Python package cvvdp 0.5.7 (MIT licence).
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrics/cvvdp/csf_table.h"

namespace wavecrest::cvvdp {

// ---- the display: 30 inch, 3840x2160, 200 cd/m2, contrast 1000, seen from 0.7472 m in an office of 250 lux ----------

constexpr double kPeakLuminance = 200;                                  // cd/m2
constexpr double kBlackLuminance = kPeakLuminance / 1000;               // of the panel
constexpr double kReflectedLuminance = 250 / std::numbers::pi * 0.005;  // the panel reflects 0.5 %
constexpr double kPixelsPerDegree = 75.40244934516305;                  // at the centre of the display

// Light that the display shows for linear light 0..1.
constexpr double displayed(double linear) {
  return (kPeakLuminance - kBlackLuminance) * linear + kBlackLuminance + kReflectedLuminance;
}

// Opponent colours DKL (white point D65) from linear sRGB, through XYZ and the cone responses LMS of CIE 2006.
std::array<std::array<double, 3>, kOpponents> opponentFromRgb();

// ---- bands ----------------------------------------------------------------------------------------------------------

// Spatial frequency of each band of an image's pyramid in cycles per degree, finest first. The last is the base band.
std::vector<double> bandFrequencies(size_t width, size_t height);

constexpr double kLeastBackground = 0.01;   // cd/m2
constexpr double kGreatestContrast = 1000;  // Weber

// log10 of the sensitivity at a frequency, at each luminance of the table.
using SensitivityCurve = std::array<double, kCsfLuminances>;
SensitivityCurve sensitivityCurve(size_t opponent, double frequency);
// Sensitivity at a background luminance, with the metric's correction in dB.
double sensitivity(const SensitivityCurve& curve, double luminance);

// Gains of the opponent channels before masking.
constexpr std::array<double, kOpponents> kChannelGain{1, 1.45, 1};

// ---- masking (kernels/cvvdp_rows.h says how) ------------------------------------------------------------------------

constexpr double kPowerOffset = 1e-5;  // powers are (x + offset)^p - offset^p, which has a slope at 0
constexpr double kDifferenceExponent = 2.264355182647705;
constexpr std::array<double, kOpponents> kMaskExponent{1.302622675895691, 2.8885908126831055, 3.6807713508605957};
constexpr double kLogMaskGain = -0.7954971194267273;           // log10
constexpr double kLogGreatestDifference = 2.5642454624176025;  // log10
// log2 of how much the first channel masks the second.
constexpr double kLogCrossMasking[kOpponents][kOpponents] = {
    {-0.18950104713439941, -5.962151050567627, -4.31834602355957},
    {2.5655593872070312, 0.34406712651252747, -2.719646453857422},
    {3.8118371963500977, -1.0051705837249756, -0.5193376541137695}};
constexpr double kMaskBlurSigma = 3;  // pixels of the band
constexpr size_t kMaskBlurRadius = 6;

// ---- pooling --------------------------------------------------------------------------------------------------------

constexpr std::array<double, kOpponents> kBaseBandWeight{0.0036334486212581396, 1.6627724170684814, 4.11874532699585};
constexpr double kBandExponent = 4, kChannelExponent = 4;
constexpr double kImageIntegration = 0.577918291091919;

inline double offsetPower(double x, double exponent) {
  return std::pow(x + kPowerOffset, exponent) - std::pow(kPowerOffset, exponent);
}

// Just-objectionable differences below 10 of a pooled difference.
double justObjectionableDifferences(double difference);

}  // namespace wavecrest::cvvdp
