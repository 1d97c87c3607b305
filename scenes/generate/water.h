// The water surface of the pool: a sum of sine waves over a rectangle, as a fine regular mesh.
//
// Caustics show every flaw of a refracting surface, so normals come from the waves' derivatives, not from facets: facet
// normals would print the grid into the light pattern.
#pragma once

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

struct WaterExtent {
  double halfX = 0, halfZ = 0;      // the mesh covers [-halfX, halfX] x [-halfZ, halfZ] around y = 0
  uint32_t cellsX = 0, cellsZ = 0;  // two triangles per cell
};

// Height of the water at (x, z), and its gradient.
struct WaterSample {
  double height = 0, slopeX = 0, slopeZ = 0;
};
WaterSample sampleWater(double x, double z);

// Normals up, triangles counter-clockwise seen from above.
Mesh makeWater(const WaterExtent& extent);

}  // namespace wavecrest::generate
