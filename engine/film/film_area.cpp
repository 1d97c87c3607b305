#include "engine/film/film_area.h"

#include <algorithm>

#include "kernels/columns/columns.h"

namespace wavecrest {
namespace {

// A square tile of camera rays fills 16 blocks of 16 lanes.
constexpr uint32_t kTile = kFilmTile;

// Interleaves the bits of x and y below kTile: neighbours in order are neighbours in the image.
uint32_t mortonInTile(uint32_t x, uint32_t y) {
  uint32_t code = 0;
  for (uint32_t bit = 0; bit < 4; ++bit) {
    code |= ((x >> bit) & 1u) << (2 * bit) | ((y >> bit) & 1u) << (2 * bit + 1);
  }
  return code;
}

}  // namespace

FilmArea FilmArea::make(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height) {
  FilmArea area{.width = width, .height = height, .x0 = x0, .y0 = y0, .pixels = {}, .tiles = {}};
  struct Key {
    uint64_t order;
    uint32_t pixel;
  };
  std::vector<Key> keys;
  keys.reserve(size_t{width} * height);
  const uint32_t tilesAcross = (width + kTile - 1) / kTile;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const uint64_t tile = uint64_t{y / kTile} * tilesAcross + x / kTile;
      keys.push_back({tile * kTile * kTile + mortonInTile(x % kTile, y % kTile), (y0 + y) << 16 | (x0 + x)});
    }
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.order < b.order; });
  area.pixels.reserve(keys.size() + kColumnPadding);
  for (size_t i = 0; i < keys.size(); ++i) {
    const uint64_t tile = keys[i].order / kTilePixels;
    if (i == 0 || keys[i - 1].order / kTilePixels != tile) area.tiles.push_back(i);
    area.pixels.push_back(keys[i].pixel);
  }
  area.tiles.push_back(keys.size());
  return area;
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
