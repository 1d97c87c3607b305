#include "engine/film/film_area.h"

#include <algorithm>

#include "kernels/columns/columns.h"

namespace wavecrest {
namespace {

// A square tile of camera rays fills 16 blocks of 16 lanes.
constexpr uint32_t kTile = kFilmTile;

// The column or row of a pixel within its tile, from its place in the tile's order: neighbours in order are neighbours
// in the image (Morton). row: 0 or 1.
uint32_t placeInTile(uint32_t code, uint32_t row) {
  uint32_t place = 0;
  for (uint32_t bit = 0; bit < 4; ++bit) place |= ((code >> (2 * bit + row)) & 1u) << bit;
  return place;
}

}  // namespace

FilmArea FilmArea::make(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height) {
  FilmArea area{.width = width, .height = height, .x0 = x0, .y0 = y0, .pixels = {}, .tiles = {}};
  area.pixels.reserve(area.size() + kColumnPadding);
  area.tiles.reserve(tilesOf(width, height) + 1);
  for (uint32_t top = 0; top < height; top += kTile) {
    for (uint32_t left = 0; left < width; left += kTile) {
      area.tiles.push_back(area.pixels.size());
      for (uint32_t code = 0; code < kTilePixels; ++code) {
        const uint32_t x = left + placeInTile(code, 0), y = top + placeInTile(code, 1);
        if (x < width && y < height) area.pixels.push_back((y0 + y) << 16 | (x0 + x));
      }
    }
  }
  area.tiles.push_back(area.pixels.size());
  return area;
}

size_t FilmArea::tilesOf(uint32_t width, uint32_t height) {
  const auto across = [](uint32_t side) { return (size_t{side} + kTile - 1) / kTile; };
  return across(width) * across(height);
}

size_t FilmArea::bytesFor(uint32_t width, uint32_t height) {
  return size_t{width} * height * sizeof(uint32_t) + (tilesOf(width, height) + 1) * sizeof(size_t);
}

std::vector<size_t> FilmArea::pieces(size_t most, bool wholeTiles) const {
  std::vector<size_t> begins;
  if (!wholeTiles) {
    for (size_t begin = 0; begin < pixels.size(); begin += most) begins.push_back(begin);
  } else {
    for (size_t tile = 0; tile + 1 < tiles.size(); ++tile) {
      if (begins.empty() || tiles[tile + 1] - begins.back() > most) begins.push_back(tiles[tile]);
    }
  }
  begins.push_back(pixels.size());
  return begins;
}

size_t FilmArea::pixelsFrom(size_t first, size_t left, size_t most, bool wholeTiles) const {
  if (!wholeTiles) return std::min(left, most);
  auto end = std::upper_bound(tiles.begin(), tiles.end(), first);
  while (std::next(end) != tiles.end() && *std::next(end) <= first + std::min(left, most)) ++end;
  return *end - first;
}

}  // namespace wavecrest
