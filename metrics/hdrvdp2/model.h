// The psychophysical model of HDR-VDP-2.2: display, optics of the eye, photoreceptors, contrast sensitivity, pooling.
//
// Functions and tables only, in double; nothing here depends on an image. Method: Mantiuk, Kim, Rempel, Heidrich,
// "HDR-VDP-2: A calibrated visual metric for visibility and quality predictions in all luminance conditions", ACM TOG
// 30(4), 2011; parameters are those of version 2.2.0 for an sRGB display and its default options.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wavecrest::vdp {

constexpr double kPixelsPerDegree = 30;

// Masking and pooling.
constexpr double kSensitivity = 1.7318442143140222;         // 0.006894596 / 10^-2.4
constexpr double kDifferenceExponent = 3.4999996425790258;  // p = 10^0.544068, not exactly 3.5
constexpr double kMaskExponent = 3.1315546849832665;        // q = 10^0.49576
constexpr double kSelfMasking = 1.5454857320359572;         // 10^0.189065
constexpr double kOrientationMasking = 2.8131895791841148;  // 10^0.449199
constexpr double kScaleMasking = 33.505800631708915;        // 10^1.52512
constexpr double kPoolingEpsilon = 1e-12;

// What surrounds the display, per RGB channel.
constexpr double kSurround = 1e-5;

enum Receptor : size_t { kLCone, kMCone, kRod, kReceptors };

// Response of each receptor to the display's R, G and B: emission of a CCFL-backlit LCD against Smith and Pokorny's
// cone fundamentals and the CIE scotopic curve.
constexpr std::array<std::array<double, kReceptors>, 3> kDisplayToReceptors{{
    {0.19899612033792871, 0.041005860407588933, 0.014377368621119191},
    {0.40476260703812544, 0.25492330644134564, 0.48092084108413191},
    {0.054390619255321161, 0.050012248959300676, 0.45427589566935994},
}};

// Light of an 8-bit code on the display, cd/m2: peak 99 above a black level of 1.
double displayLight(uint8_t code);

// Modulation transfer function of the eye's optics; rho in cycles per degree.
double opticalTransfer(double rho);

// Photoreceptor response tables: integrated sensitivity over log10 luminance, kVdpLightNodes from 1e-5 to 1e5 cd/m2.
struct ResponseTables {
  std::vector<double> cone, rod;
};
ResponseTables makeResponseTables();

// Neural contrast sensitivity at a frequency (cycles per degree) and an adapting luminance (cd/m2).
double contrastSensitivity(double frequency, double luminance);

// Weight of a band of the given frequency in the pooled score.
double bandWeight(double frequency);

// The mean opinion score, 0 to 100, of a pooled score Q.
double meanOpinionScore(double q);

}  // namespace wavecrest::vdp
