#include "engine/film/spread_sums.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

// How far a Gaussian's samples lie from the centre at most, in standard deviations: uniform numbers have 24 bits.
constexpr double kFarthestSample = 5.8;

// Pixels that the filter reaches from the nearest one on, and that a tile's samples reach around it.
uint32_t reachOf(const CameraView& camera) { return static_cast<uint32_t>(filterRadius(camera) + 0.5); }
uint32_t marginOf(const CameraView& camera) {
  const double farthest = camera.filter == FilterKind::tent ? camera.filterScale : kFarthestSample * camera.filterScale;
  return reachOf(camera) + static_cast<uint32_t>(farthest + 0.5);
}

}  // namespace

bool canSpread(const CameraView& camera) {
  return camera.filter != FilterKind::box && filterRadius(camera) <= kWidestSpread;
}

SpreadSums::SpreadSums(const CameraView& camera, const FilmArea& area)
    : filter_(camera.filter),
      filterScale_(camera.filterScale),
      radius_(filterRadius(camera)),
      reach_(reachOf(camera)),
      margin_(marginOf(camera)),
      width_(area.width),
      height_(area.height),
      rowSize_(kFilmTile + 2 * margin_),
      planeSize_(rowSize_ * rowSize_) {
  assert(canSpread(camera));
  // Find the corner of each tile, and the place of each pixel within its tile.
  const auto xOf = [&](size_t pixel) { return (area.pixels[pixel] & 0xffffu) - area.x0; };
  const auto yOf = [&](size_t pixel) { return (area.pixels[pixel] >> 16) - area.y0; };
  for (size_t i = 0; i + 1 < area.tiles.size(); ++i) {
    const size_t first = area.tiles[i];
    tiles_.push_back({first, area.tiles[i + 1] - first, xOf(first), yOf(first)});
    for (size_t pixel = first; pixel < area.tiles[i + 1]; ++pixel) {
      const uint32_t x = xOf(pixel) - tiles_.back().x, y = yOf(pixel) - tiles_.back().y;
      place_.push_back(static_cast<uint8_t>(y * kFilmTile + x));
    }
  }
  // Each tile has three planes.
  sums_.resize(3 * planeSize_ * tiles_.size());
}

size_t SpreadSums::bytesFor(const CameraView& camera, const FilmArea& area) {
  const size_t rowSize = kFilmTile + 2 * marginOf(camera);
  return 3 * rowSize * rowSize * FilmArea::tilesOf(area.width, area.height) * sizeof(double) + area.size();
}

double SpreadSums::filterAt(double distance) const {
  if (std::abs(distance) > radius_) return 0;
  if (filter_ == FilterKind::tent) return 1 - std::abs(distance) / filterScale_;
  return std::exp(-0.5 * distance * distance / (filterScale_ * filterScale_));
}

SpreadAxis SpreadSums::axis(double place, uint32_t corner, uint32_t size) const {
  // The taps are the pixels around the one that is nearest to the sample.
  const double fromCentre = place - 0.5;
  const int nearest = static_cast<int>(std::floor(fromCentre + 0.5)), reach = static_cast<int>(reach_);
  SpreadAxis axis;
  axis.taps = 2 * reach_ + 1;
  // `first` is where the first tap of the tile's first pixel lies in the tile's sums.
  axis.first = static_cast<uint32_t>(static_cast<int>(margin_) + nearest - reach);
  for (int tap = 0; tap < static_cast<int>(axis.taps); ++tap) {
    axis.weight[tap] = static_cast<float>(filterAt(fromCentre - (nearest - reach + tap)));
  }
  // The density of samples there: the filters of all pixels of the film that reach the place.
  for (int pixel = 0; pixel < static_cast<int>(kFilmTile); ++pixel) {
    double density = 0;
    for (int tap = 0; tap < static_cast<int>(axis.taps); ++tap) {
      const int64_t other = int64_t{corner} + pixel + nearest - reach + tap;
      if (other >= 0 && other < int64_t{size}) density += static_cast<double>(axis.weight[tap]);
    }
    axis.scale[pixel] = density > 0 ? static_cast<float>(1 / density) : 0;
  }
  return axis;
}

TileSums SpreadSums::sumsOf(size_t tile) { return {sums_.data() + 3 * planeSize_ * tile, rowSize_, planeSize_}; }

template <class S>
uint64_t SpreadSums::add(const Wave<S>& wave, std::span<const FilterPlace> places, SpreadSamples<S> spreadSamples) {
  const size_t pixels = wave.pathCount >> wave.iterationBits;
  assert(places.size() == size_t{1} << wave.iterationBits);
  // Find the wave's first tile. A wave begins with a whole tile.
  const auto first = std::lower_bound(tiles_.begin(), tiles_.end(), wave.firstPath,
                                      [](const Tile& tile, size_t pixel) { return tile.firstPixel < pixel; });
  uint64_t nonFinite = 0;
  for (auto tile = first; tile != tiles_.end() && tile->firstPixel < wave.firstPath + pixels; ++tile) {
    const size_t lane = (tile->firstPixel - wave.firstPath) << wave.iterationBits;
    // Add one iteration after the other. Samples of an iteration lie places.size() lanes apart.
    for (size_t i = 0; i < places.size(); ++i) {
      const TileSamples<S> samples{.red = wave.radiance.red + lane + i,
                                   .green = wave.radiance.green + lane + i,
                                   .blue = wave.radiance.blue + lane + i,
                                   .stride = places.size(),
                                   .count = tile->pixels,
                                   .place = place_.data() + tile->firstPixel};
      nonFinite += spreadSamples(samples, axis(places[i].x, tile->x, width_), axis(places[i].y, tile->y, height_),
                                 sumsOf(static_cast<size_t>(tile - tiles_.begin())));
    }
  }
  return nonFinite;
}
template uint64_t SpreadSums::add(const Wave<float>&, std::span<const FilterPlace>, SpreadSamples<float>);
template uint64_t SpreadSums::add(const Wave<double>&, std::span<const FilterPlace>, SpreadSamples<double>);

std::vector<double> SpreadSums::resolve(std::span<const uint64_t> samples) const {
  std::vector<double> image(3 * size_t{width_} * height_);
  // Sums of neighbouring tiles overlap by the margins. Each tile's sums are divided by that tile's number of samples.
  for (size_t i = 0; i < tiles_.size(); ++i) {
    const Tile& tile = tiles_[i];
    const auto count = static_cast<double>(samples[tile.firstPixel]);
    if (count == 0) continue;
    // The part of the tile's sums that lies on the film.
    const auto begin = [&](uint32_t corner) { return corner < margin_ ? margin_ - corner : 0; };
    const auto end = [&](uint32_t corner, uint32_t size) {
      return std::min<size_t>(rowSize_, size_t{size} + margin_ - corner);
    };
    for (size_t row = begin(tile.y); row < end(tile.y, height_); ++row) {
      for (size_t column = begin(tile.x); column < end(tile.x, width_); ++column) {
        const size_t pixel = (tile.y + row - margin_) * width_ + tile.x + column - margin_;
        for (size_t c = 0; c < 3; ++c) {
          image[3 * pixel + c] += sums_[(3 * i + c) * planeSize_ + row * rowSize_ + column] / count;
        }
      }
    }
  }
  return image;
}

void SpreadSums::add(const SpreadSums& other) {
  std::transform(sums_.begin(), sums_.end(), other.sums_.begin(), sums_.begin(), std::plus<>());
}

void SpreadSums::save(StateWriter& out) const { out.items(sums_.data(), sums_.size()); }
void SpreadSums::restore(StateReader& in) { in.items(sums_.data(), sums_.size()); }
void SpreadSums::addSaved(StateReader& in) { in.addTo(std::span(sums_)); }

}  // namespace wavecrest
