// The film: what all iterations have added up to, pixel by pixel.
//
// Sums are in double, so a million iterations lose nothing that float samples had. A pixel's samples are added in the
// order of iterations, whatever thread computes them, so an image is the same bit for bit on any number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/columns/wave.h"

namespace wavecrest {

// The rectangle of the full film that is rendered, and the order in which its pixels are cut into waves.
struct FilmArea {
  uint32_t width = 0, height = 0;  // of the rendered rectangle
  uint32_t x0 = 0, y0 = 0;         // its corner in the full film
  std::vector<uint32_t> pixels;    // raster (y << 16 | x) in the full film, in wave order: small tiles, so that
                                   // the camera rays of a wave stay together
  static FilmArea make(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height);
};

class Film {
 public:
  explicit Film(FilmArea area);

  // Adds one sample for each path of the wave, a pixel's in the order of their iterations. Samples that are not finite
  // count as black; returns how many there were. Waves of disjoint pixels may be added at the same time.
  template <class S>
  uint64_t add(const Wave<S>& wave);

  // What has been splatted so far, in fixed point (kSplatScale), row by row, and the factor that makes it radiance: for
  // light paths one over their number.
  void setSplats(std::vector<int64_t> sums, double factor);

  // The image, row by row from the top, RGB: the mean of each pixel's samples (black where there are none) plus the
  // splats.
  std::vector<float> resolve() const;

  const FilmArea& area() const { return area_; }
  uint64_t minSamples() const;

 private:
  FilmArea area_;
  std::vector<double> sums_;       // RGB, in wave order
  std::vector<uint32_t> samples_;  // in wave order
  std::vector<int64_t> splats_;
  double splatFactor_ = 0;
};

}  // namespace wavecrest
