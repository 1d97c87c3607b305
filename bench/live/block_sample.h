// A sample of an image's blocks, spread evenly over it: what the error of a large film is estimated from while it
// renders, at a cost that does not grow with the film.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/film/pixel_blocks.h"

namespace wavecrest {

class BlockSample {
 public:
  // At most `most` of the whole blocks of a film; all of them where there are no more. A film without one whole block
  // has none.
  BlockSample(size_t width, size_t height, size_t most);

  size_t count() const { return blocks_.size(); }
  // The blocks of a film (RGB, row by row), one below the other: an image kWidth wide.
  std::vector<float> take(std::span<const float> film) const;
  static constexpr size_t kWidth = PixelBlocks::kSide;

 private:
  size_t width_, filmBlocks_;   // filmBlocks_: whole ones
  std::vector<size_t> blocks_;  // the pixel at the upper left of each
};

}  // namespace wavecrest
