// PhotonGrid for kernels: cells and places of a vector of points.
#pragma once

#include "kernels/columns/photon_grid.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

struct CellLanes {
  UInt x, y, z;
};

// Of points in the grid, in cells.
template <class Real>
WAVECREST_INLINE CellLanes cellsOf(Vec3<Real> point) {
  const auto cell = [](Real x) WAVECREST_LAMBDA { return toUInt(to<Float>(floor(x))); };
  return {cell(point.x), cell(point.y), cell(point.z)};
}

// PhotonGrid::strip
WAVECREST_INLINE UInt stripOf(UInt y, UInt z) {
  UInt h = (y * UInt(0x9e3779b1u)) ^ (z * UInt(0x85ebca77u));
  h = h ^ shiftRight<15>(h);
  h = h * UInt(0x2c1b3c6du);
  return h ^ shiftRight<12>(h);
}

template <class Real>
class GridLanes {
 public:
  WAVECREST_INLINE explicit GridLanes(const PhotonGrid<typename Real::Storage>& grid)
      : origin_{Real(grid.origin[0]), Real(grid.origin[1]), Real(grid.origin[2])}, inverseCell_(grid.inverseCell) {}

  // A position in cells from the origin on.
  WAVECREST_INLINE Vec3<Real> operator()(Vec3<Real> position) const { return (position - origin_) * inverseCell_; }

 private:
  Vec3<Real> origin_;
  Real inverseCell_;
};

// As in a place: the bits of each axis, the parity of a cell as the highest of them.
WAVECREST_INLINE UInt packAxes(UInt x, UInt y, UInt z) {
  return x | shiftLeft<kQuantaBits>(y) | shiftLeft<2 * kQuantaBits>(z);
}
WAVECREST_INLINE UInt parityBit(UInt cell) { return shiftLeft<kQuantaBits - 1>(cell & UInt(1u)); }

// What a photon map is built from: the number of each point's cell, before it is masked, and the point's place.
struct PlaceLanes {
  UInt cell, place;
};
template <class Real>
WAVECREST_INLINE PlaceLanes placesOf(Vec3<Real> point) {
  const CellLanes cell = cellsOf(point);
  const auto quanta = [](Real x, UInt c) WAVECREST_LAMBDA {
    const Real within = (x - floor(x)) * Real(static_cast<float>(kQuantaPerCell));
    return toUInt(to<Float>(floor(within))) | parityBit(c);
  };
  const UInt strip = stripOf(cell.y, cell.z);
  const UInt within = packAxes(quanta(point.x, cell.x), quanta(point.y, cell.y), quanta(point.z, cell.z));
  return {strip + cell.x, within | (strip & UInt(kPlaceStripMask))};
}

WAVECREST_SIMD_END
