// Colours of a scene file as linear Rec. 709 RGB, converted as Mitsuba's rgb variants do.
//
// A value is a <float> (grey), an <rgb>, an <srgb> (hexadecimal or gamma-encoded), a <spectrum> (one number,
// wavelength:value pairs or a file of them), a <blackbody> of 0.5 and 0.6, or an object <spectrum type=…>. What a
// spectrum becomes depends on its role: reflectance is seen under D65 and clamped to [0, 1]; radiance is integrated as
// it is, so that a flat spectrum is slightly pink. In files of 0.4 to 0.6 all spectra are integrated as they are, and
// <spectrum> with one number is grey.
#pragma once

#include <span>

#include "engine/load/context.h"

namespace wavecrest {

enum class ColorRole {
  reflectance,  // in [0, 1]
  unbounded,    // not a reflectance: roughness, absorption
  refraction,   // index of refraction: slightly below 0, as fits of measurements leave it, it is 0 with a note
  emission,
};

// The colour of a value element or a <spectrum type=…> object; anything else is an error, and so are channels below 0
// or beyond the range of a float. A reflectance above 1 is an error but for objects.
Rgb readColor(LoadContext& context, const XmlElement& element, ColorRole role);

// A piecewise linear spectrum, zero outside its wavelengths (nm, increasing), as RGB. legacy: of a file of 0.4 to 0.6.
Rgb spectrumToRgb(std::span<const double> wavelengths, std::span<const double> values, ColorRole role, bool legacy);

double srgbToLinear(double encoded);

}  // namespace wavecrest
