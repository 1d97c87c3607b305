// Images in blocks of 8 x 8 pixels: large enough that noise averages out, small enough to tell where something is.
#pragma once

#include <cstddef>

namespace wavecrest {

struct PixelBlocks {
  static constexpr size_t kSide = 8;

  size_t width = 0, height = 0;  // of the image, pixels

  // samples: of an image in RGB, row by row.
  static PixelBlocks of(size_t samples, size_t width) { return {width, samples / (3 * width)}; }

  size_t samples() const { return 3 * width * height; }
  size_t across() const { return (width + kSide - 1) / kSide; }
  size_t down() const { return (height + kSide - 1) / kSide; }
  size_t count() const { return across() * down(); }
  // The block of a sample, by its index in the image. Blocks are counted row by row.
  size_t ofSample(size_t index) const {
    const size_t pixel = index / 3;
    return pixel / width / kSide * across() + pixel % width / kSide;
  }
};

}  // namespace wavecrest
