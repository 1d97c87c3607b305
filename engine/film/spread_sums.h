// What spread samples have added up to (kernels/columns/filter_spread.h), tile by tile.
//
// Each tile has sums of its own, over its pixels and a margin around them. Tiles can therefore be added to at the same
// time, and the additions of a tile have one order, that of the iterations: an image is the same bit for bit however
// tiles are dealt to waves and threads. resolve() adds the tiles together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/film/film_area.h"
#include "kernels/columns/wave.h"

namespace wavecrest {

class StateReader;
class StateWriter;

// Whether samples of this filter can be spread: it is no box, which reaches its own pixel alone, and no wider than
// kWidestSpread.
bool canSpread(const CameraView& camera);

class SpreadSums {
 public:
  // canSpread(camera) must hold.
  SpreadSums(const CameraView& camera, const FilmArea& area);

  // Adds the samples of a wave of whole tiles. places: of the wave's iterations. Returns how many were not finite.
  template <class S>
  uint64_t add(const Wave<S>& wave, std::span<const FilterPlace> places, SpreadSamples<S> spreadSamples);

  // The image, row by row, RGB. samples: of each pixel in wave order; all pixels of a tile have the same number.
  std::vector<double> resolve(std::span<const uint64_t> samples) const;

  // Adds the sums of another film of the same size and filter.
  void add(const SpreadSums& other);
  FilterKind filter() const { return filter_; }
  double filterScale() const { return filterScale_; }

  void save(StateWriter& out) const;
  void restore(StateReader& in);
  void addSaved(StateReader& in);
  static size_t bytesFor(const CameraView& camera, const FilmArea& area);
  size_t bytes() const { return sums_.size() * sizeof(double) + place_.size(); }

 private:
  struct Tile {
    size_t firstPixel, pixels;
    uint32_t x, y;  // its corner in the rendered rectangle
  };
  // The weights along one axis, for samples at this place of pixels from `corner` on. size: of the film along it.
  SpreadAxis axis(double place, uint32_t corner, uint32_t size) const;
  double filterAt(double distance) const;  // up to a factor
  TileSums sumsOf(size_t tile);

  FilterKind filter_;
  double filterScale_, radius_;
  uint32_t reach_, margin_;  // in pixels: of the filter from the nearest pixel; of a tile's sums around it
  uint32_t width_, height_;
  size_t rowSize_, planeSize_;
  std::vector<Tile> tiles_;
  std::vector<uint8_t> place_;  // of each pixel within its tile, in wave order (TileSamples)
  std::vector<double> sums_;
};

}  // namespace wavecrest
