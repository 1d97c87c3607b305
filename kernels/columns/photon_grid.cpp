// The grid that photons are sorted by (photon_grid.h).
#include "kernels/columns/photon_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wavecrest {
namespace {

// Where photons are few for the radius, cells are wider than a search. A search looks at (1 + 2r / c)^2 runs and at the
// photons on about (c + 2r)^2 of a surface: with n photons on a unit of area the sum is least at c^3 = k r / n, and k
// is twice what a run costs in photons. Measured: 2.5 and 9 are slower by a percent or two.
constexpr double kTwiceRunInPhotons = 5;

}  // namespace

template <class S>
PhotonGrid<S> PhotonGrid<S>::over(const double (&center)[3], double radius, double searchRadius, double photons) {
  PhotonGrid grid;
  double farthest = 0;
  for (const double c : center) farthest = std::max(farthest, std::abs(c) + radius);
  // Points are found on surfaces but for their rounding, and searches reach as far as their radius beyond.
  const double margin = 4 * searchRadius + 0x1p-18 * farthest;
  for (size_t axis = 0; axis < 3; ++axis) grid.origin[axis] = static_cast<S>(center[axis] - radius - margin);
  const double extent = 2 * (radius + margin);
  // A shade wider than the diameter, so that rounding cannot put the far end of a query into a third cell.
  double cell = 2 * searchRadius * (1 + 1e-4);
  // Cell numbers stay exact in S and within 21 bits: a search of smaller radius than that reads somewhat more photons.
  cell = std::max(cell, extent / (1 << 21));
  // As if photons lay on the faces of the cube in the sphere.
  const double faces = 8 * radius * radius;
  cell = std::max(cell, std::cbrt(kTwiceRunInPhotons * searchRadius * faces / photons));
  grid.inverseCell = static_cast<S>(1 / cell);
  // Along each axis half a quantum, and for either point two roundings of as many quanta as there may be.
  const double rounded = 4 * extent / cell * kQuantaPerCell * std::numeric_limits<S>::epsilon();
  grid.slack = static_cast<float>(std::sqrt(3.0) * (0.5 + rounded + 1e-3));
  return grid;
}

template <class S>
typename PhotonGrid<S>::Photon PhotonGrid<S>::at(const S (&position)[3]) const {
  uint32_t cell[3], place = 0;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const S inCells = (position[axis] - origin[axis]) * inverseCell, low = std::floor(inCells);
    cell[axis] = static_cast<uint32_t>(low);
    const auto quanta = static_cast<uint32_t>(std::floor((inCells - low) * S{kQuantaPerCell}));
    place |= (quanta | cell[axis] % 2 * kQuantaPerCell) << axis * kQuantaBits;
  }
  const uint32_t alongX = strip(cell[1], cell[2]);
  return {alongX + cell[0], place | (alongX & kPlaceStripMask)};
}

template struct PhotonGrid<float>;
template struct PhotonGrid<double>;

}  // namespace wavecrest
