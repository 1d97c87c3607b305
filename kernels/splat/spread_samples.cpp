// spreadSamples: adds the samples of one tile and iteration to the pixels around them
// (kernels/columns/filter_spread.h). filterPlaces: where in the filter the iterations place their samples, for whoever
// computes the weights.
//
// in: the tile's samples, and the weights along both axes. out: the tile's sums. The filter is separable: first down
// the columns into a line of sums, then along the line. Samples that are not finite count as black.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernels/endpoints/camera_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

template <class S>
using LanesOf = std::conditional_t<std::is_same_v<S, double>, Double, Float>;

// A line of the tile between margins of zeros, which the taps at its ends read.
constexpr size_t kBefore = 16;
constexpr size_t kLine = kBefore + kFilmTile + 2 * 16;
static_assert(kBefore >= kMostTaps - 1 && kLanes <= 16);

template <class S>
struct Tile {
  HWY_ALIGN S planes[3][kTilePixels];
};

// The samples in the order of pixels, times their pixels' scales.
template <class S>
uint64_t collect(const TileSamples<S>& samples, const SpreadAxis& x, const SpreadAxis& y, Tile<S>& tile) {
  uint64_t nonFinite = 0;
  for (size_t i = 0; i < samples.count; ++i) {
    const size_t lane = i * samples.stride, place = samples.place[i];
    const S red = samples.red[lane], green = samples.green[lane], blue = samples.blue[lane];
    const S scale = static_cast<S>(x.scale[place % kFilmTile] * y.scale[place / kFilmTile]);
    const bool finite = std::isfinite(red + green + blue);
    nonFinite += finite ? 0 : 1;
    tile.planes[0][place] = finite ? red * scale : 0;
    tile.planes[1][place] = finite ? green * scale : 0;
    tile.planes[2][place] = finite ? blue * scale : 0;
  }
  return nonFinite;
}

}  // namespace

template <class S>
uint64_t spreadSamples(const TileSamples<S>& samples, const SpreadAxis& x, const SpreadAxis& y, const TileSums& sums) {
  using Real = LanesOf<S>;
  Tile<S> tile;
  // Pixels beyond the film's edge have no samples.
  if (samples.count != kTilePixels) tile = Tile<S>{};
  const uint64_t nonFinite = collect(samples, x, y, tile);
  HWY_ALIGN S line[kLine]{};
  const size_t width = kFilmTile + x.taps - 1;
  for (size_t c = 0; c < 3; ++c) {
    double* const plane = sums.values + c * sums.planeSize;
    for (size_t row = 0; row < kFilmTile + y.taps - 1; ++row) {
      // Rows of the tile that add to this row of the sums.
      const size_t firstTap = row < kFilmTile ? 0 : row - (kFilmTile - 1);
      const size_t endTap = std::min<size_t>(row + 1, y.taps);
      for (size_t column = 0; column < kFilmTile; column += kLanes) {
        Real sum(0);
        for (size_t tap = firstTap; tap < endTap; ++tap) {
          const S* const from = tile.planes[c] + (row - tap) * kFilmTile + column;
          sum = mulAdd(Real(y.weight[tap]), load(from), sum);
        }
        store(sum, line + kBefore + column);
      }
      double* const target = plane + (y.first + row) * sums.rowSize + x.first;
      for (size_t column = 0; column < width; column += kLanes) {
        Real sum(0);
        for (size_t tap = 0; tap < x.taps; ++tap) {
          sum = mulAdd(Real(x.weight[tap]), loadUnaligned(line + kBefore + column - tap), sum);
        }
        if (column + kLanes <= width) {
          storeUnaligned(loadUnaligned(target + column) + to<Double>(sum), target + column);
          continue;
        }
        // What follows the row may be the sums of another tile, to which another thread adds at the same time.
        HWY_ALIGN double rest[kLanes];
        store(to<Double>(sum), rest);
        for (size_t k = 0; k < width - column; ++k) target[column + k] += rest[k];
      }
    }
  }
  return nonFinite;
}
template uint64_t spreadSamples(const TileSamples<float>&, const SpreadAxis&, const SpreadAxis&, const TileSums&);
template uint64_t spreadSamples(const TileSamples<double>&, const SpreadAxis&, const SpreadAxis&, const TileSums&);

template <class S>
void filterPlaces(const CameraView& camera, const SamplerSettings& sampler, size_t count, FilterPlace* places) {
  using Real = LanesOf<S>;
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec2<Real> place = sharedPlace<Real>(camera, sampler, laneIndex(static_cast<uint32_t>(i)));
    HWY_ALIGN S xs[kLanes], ys[kLanes];
    store(place.x, xs);
    store(place.y, ys);
    for (size_t k = 0; k < std::min(kLanes, count - i); ++k) places[i + k] = {xs[k], ys[k]};
  }
}
template void filterPlaces<float>(const CameraView&, const SamplerSettings&, size_t, FilterPlace*);
template void filterPlaces<double>(const CameraView&, const SamplerSettings&, size_t, FilterPlace*);

WAVECREST_SIMD_END
