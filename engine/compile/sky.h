// The clear sky and its sun, baked into an environment map and a disc in front of it.
#pragma once

#include "engine/compile/textures.h"

namespace wavecrest {

// The sun is the disc of EnvironmentView, of even radiance, and the map has the sky. A sun below the horizon leaves
// both black, as in Mitsuba 3.
Environment compileSky(const SunskyEmitter& emitter);

// Radiance of the sky, for tests: cosTheta of the angle from the zenith, 0 to 1, and the angle to the sun. Units are
// W / (m^2 sr nm), as in Mitsuba 3.
Rgb skyRadiance(double turbidity, const Rgb& albedo, double sunElevation, double cosTheta, double sunAngle);
// Irradiance on a surface that faces the sun.
Rgb sunIrradiance(double turbidity, double sunElevation);

}  // namespace wavecrest
