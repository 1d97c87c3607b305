// How much light a rough dielectric boundary lets pass, as a function of the angle of incidence: the table of rough
// plastic.
#pragma once

#include <array>

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

struct RoughBoundary {
  Distribution distribution = Distribution::ggx;
  double alpha = 0.1;
  double eta = 1.5;  // index beyond the boundary over the index on the light's side

  // Shares of the light from cos(theta) = mu > 0 that is transmitted and reflected by one meeting with a microfacet;
  // what then would meet another (1 - G1) is in neither.
  double transmittance(double mu) const;
  double reflectance(double mu) const;
};

// Transmittance at the nodes mu = i / (kTransmittanceSize - 1).
std::array<float, kTransmittanceSize> transmittanceTable(const RoughBoundary& boundary);

// Reflectance for diffuse light from within, as Mitsuba 3's `roughplastic` averages it: the plain mean of R(mu) 2 mu
// over the table's nodes. The trapezoidal rule would give a value 1.5 % higher for eta = 1.5.
double internalReflectance(const RoughBoundary& boundary);

}  // namespace wavecrest
