// The grid by which photons are sorted and searched for: cells, and about where in its cell a photon lies.
#pragma once

#include <cstdint>

namespace wavecrest {

// A photon's place: for x, y and z, from the lowest bit on, kQuantaBits of its coordinate in quanta, the highest of
// them being the parity of its cell; above them the highest bits of the strip of its cell.
constexpr uint32_t kQuantaBits = 9;
constexpr uint32_t kQuantaPerCell = 1u << (kQuantaBits - 1);
constexpr uint32_t kQuantaMask = (1u << kQuantaBits) - 1;
constexpr uint32_t kPlaceStripShift = 3 * kQuantaBits;
static_assert(kPlaceStripShift < 32);
constexpr uint32_t kPlaceStripMask = ~0u << kPlaceStripShift;

// cell = floor((position - origin) * inverseCell) along each axis, in S and without contraction, so that all who count
// cells agree to the bit. Cells are at least as wide as a search's diameter: it touches one or two along each axis.
template <class S>
struct PhotonGrid {
  S origin[3]{};
  S inverseCell = 0;
  // In quanta: by how much the distance of a point to the middle of another's quantum may exceed that between the two,
  // roundings included.
  float slack = 0;

  // Over the sphere around a scene. searchRadius: of the searches that will follow; photons: about how many there will
  // be, which decides over speed only. All positive.
  static PhotonGrid over(const double (&center)[3], double radius, double searchRadius, double photons);

  // What a photon map sorts by: the number of a photon's cell, and its place (above).
  struct Photon {
    uint32_t cell, place;
  };
  // position: in the sphere, but for rounding. Kernels have the same in lanes (photon_grid_lanes.h).
  Photon at(const S (&position)[3]) const;

  // A strip of cells along x, by a hash; its cells are numbered strip + x.
  static constexpr uint32_t strip(uint32_t y, uint32_t z) {
    uint32_t h = y * 0x9e3779b1u ^ z * 0x85ebca77u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ h >> 12;
  }
};

}  // namespace wavecrest
