// The rectangle of the film that is rendered, and how it is cut into work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/stages.h"

namespace wavecrest {

// The rectangle of the full film that is rendered, and the order in which its pixels are cut into waves.
struct FilmArea {
  uint32_t width = 0, height = 0;  // of the rendered rectangle
  uint32_t x0 = 0, y0 = 0;         // its corner in the full film
  std::vector<uint32_t> pixels;    // raster (y << 16 | x) in the full film, in wave order: small tiles, so that
                                   // the camera rays of a wave stay together
  std::vector<size_t> tiles;       // where each tile of kFilmTile pixels begins in that order, and the end
  size_t size() const { return size_t{width} * height; }  // pixels
  FilmWindow window() const { return {x0, y0, width, height}; }
  // The pixels cut into pieces of up to `most`: where each begins, and the end. wholeTiles: no tile is cut, so a piece
  // may have more pixels where `most` is less than a tile.
  std::vector<size_t> pieces(size_t most, bool wholeTiles) const;
  // How many of `left` pixels from `first` on make up to `most`; of whole tiles at least one tile, where first begins.
  size_t pixelsFrom(size_t first, size_t left, size_t most, bool wholeTiles) const;
  size_t bytes() const { return bytesFor(width, height); }
  static size_t bytesFor(uint32_t width, uint32_t height);
  static size_t tilesOf(uint32_t width, uint32_t height);
  static FilmArea make(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height);
};

}  // namespace wavecrest
