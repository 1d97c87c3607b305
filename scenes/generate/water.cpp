#include "scenes/generate/water.h"

#include <numbers>

namespace wavecrest::generate {
namespace {

struct Wave {
  double length, amplitude;  // metres
  double directionDegrees, phase;
};

// Slopes of 0.1 rms focus sunlight into a clear net at about two metres' depth. Lengths have no common period and
// directions are spread, so the pattern does not repeat across the basin.
constexpr Wave kWaves[] = {
    {1.90, 0.0190, 17, 0.0},  {1.27, 0.0130, -38, 1.3}, {0.83, 0.0085, 71, 2.1},
    {0.61, 0.0050, -12, 0.7}, {0.43, 0.0032, 118, 4.0}, {0.29, 0.0016, 49, 5.2},
};

}  // namespace

WaterSample sampleWater(double x, double z) {
  WaterSample sample;
  for (const Wave& wave : kWaves) {
    const double k = 2 * std::numbers::pi / wave.length;
    const double direction = wave.directionDegrees * std::numbers::pi / 180;
    const double kx = k * std::cos(direction), kz = k * std::sin(direction);
    const double angle = kx * x + kz * z + wave.phase;
    sample.height += wave.amplitude * std::sin(angle);
    sample.slopeX += wave.amplitude * kx * std::cos(angle);
    sample.slopeZ += wave.amplitude * kz * std::cos(angle);
  }
  return sample;
}

Mesh makeWater(const WaterExtent& extent) {
  Mesh mesh;
  const uint32_t columns = extent.cellsX + 1;
  for (uint32_t j = 0; j <= extent.cellsZ; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const double x = extent.halfX * (2.0 * i / extent.cellsX - 1);
      const double z = extent.halfZ * (2.0 * j / extent.cellsZ - 1);
      const WaterSample water = sampleWater(x, z);
      mesh.addVertex({x, water.height, z}, normalize({-water.slopeX, 1, -water.slopeZ}));
    }
  }
  for (uint32_t j = 0; j < extent.cellsZ; ++j) {
    for (uint32_t i = 0; i < extent.cellsX; ++i) {
      const uint32_t corner = j * columns + i;
      mesh.addQuad(corner, corner + columns, corner + columns + 1, corner + 1);
    }
  }
  return mesh;
}

}  // namespace wavecrest::generate
