// Coefficients of the sky and sun of Hosek and Wilkie in linear sRGB.
//
// Source: the authors' published data set, (c) 2012-2013 Lukas Hosek and Alexander Wilkie, 3-clause BSD licence
// (THIRD_PARTY.md). The sky's values are those of the data set, "An Analytic Model for Full Spectral Sky-Dome Radiance"
// (SIGGRAPH 2012). The sun's are its irradiance, integrated over the disc and the sensitivities of the three channels,
// negative ones 0; "Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model" (IEEE CG&A 2013).
#pragma once

#include <cstddef>

namespace wavecrest {

// Radiance, and the parameters A to I of the distribution of radiance over the sky.
struct SkyCoefficients {
  double radiance, shape[9];
};

constexpr size_t kSkyTurbidities = 10;  // 1 to 10
constexpr size_t kSkyAlbedos = 2;       // of the ground, 0 and 1
constexpr size_t kSkyControls = 6;      // of a Bezier curve over the cube root of the sun's elevation
constexpr size_t kSunElevations = 30;   // 2 to 89 degrees

// By turbidity, albedo, control point and channel; what it gives is kSkyUnit times the radiance.
extern const SkyCoefficients kSkyCoefficients[kSkyTurbidities][kSkyAlbedos][kSkyControls][3];
constexpr double kSkyUnit = 106.7502593994140625;  // the integral of the CIE's y: radiance per nanometre to RGB

// On a surface that faces the sun, by turbidity, elevation and channel.
extern const double kSunIrradiance[kSkyTurbidities][kSunElevations][3];

}  // namespace wavecrest
