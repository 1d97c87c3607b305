// How camera samples reach the pixels around them, as plain data.
//
// A sample at raster r belongs to every pixel j whose reconstruction filter h(r - centre_j) is not zero. Pixel p places
// its sample at centre_p + o with o distributed like h, so the density of samples at r is the sum of h(r - centre_p)
// over all pixels p of the film, and a sample adds to pixel j with the weight
//
//     h(r - centre_j) / sum over p of h(r - centre_p),
//
// the balance heuristic over pixels (Veach and Guibas 1995). The image is unbiased up to the film's edge, and a
// sample's weights add up to one.
//
// All pixels share o within an iteration. Inside the film the weights that a pixel receives then add up to one as well:
// spreading adds no noise of its own, and the weights are those of a small separable convolution, the same for every
// pixel. At the film's edge they add up to one on average. Iterations come in pairs of o and -o, whose weights together
// are one there up to a few percent.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wavecrest {

// Samples are spread tile by tile: squares of kFilmTile pixels, fewer at the film's right and lower edge.
constexpr uint32_t kFilmTile = 16;
constexpr size_t kTilePixels = size_t{kFilmTile} * kFilmTile;

// Filters that reach further than this, in pixels, are sampled and not spread: a tile's sums would be mostly margin.
constexpr double kWidestSpread = 4.5;
constexpr uint32_t kMostTaps = 11;  // pixels along an axis within kWidestSpread of a point

// A place in the filter, from the corner of the pixel; the pixel's centre is (0.5, 0.5).
struct FilterPlace {
  double x = 0.5, y = 0.5;
};

// One axis of a tile's spreading: column (or row) p of the tile adds to the sums' column first + p + t with the weight
// scale[p] weight[t].
struct SpreadAxis {
  uint32_t first = 0, taps = 0;
  float weight[kMostTaps]{};
  float scale[kFilmTile]{};
};

// The samples of one tile and iteration: pixel i has red[i * stride] and so on, and lies at place[i] = kFilmTile * row
// + column of the tile.
template <class S>
struct TileSamples {
  const S *red, *green, *blue;
  size_t stride, count;
  const uint8_t* place;
};

// What a tile's samples have added up to: a plane of each colour, row by row, over the tile and the margin around it.
struct TileSums {
  double* values = nullptr;
  size_t rowSize = 0, planeSize = 0;
};

}  // namespace wavecrest
