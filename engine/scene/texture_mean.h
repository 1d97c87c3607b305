// The mean of a texture.
#pragma once

#include <algorithm>
#include <cstddef>
#include <variant>

#include "engine/scene/scene.h"

namespace wavecrest {

// The mean colour of a bitmap's texels, or of a checkerboard's two colours. A bitmap of one channel is grey.
inline Rgb mean(const Texture& texture) {
  Rgb sum{};
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    for (size_t i = 0; i < 3; ++i) sum[i] = (checkerboard->color0[i] + checkerboard->color1[i]) / 2;
    return sum;
  }
  const Bitmap& bitmap = *std::get<BitmapTexture>(texture.kind).bitmap;
  const size_t pixels = size_t{bitmap.width} * bitmap.height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t i = 0; i < 3; ++i) sum[i] += bitmap.pixels[p * bitmap.channels + (bitmap.channels == 3 ? i : 0)];
  }
  for (double& channel : sum) channel /= static_cast<double>(std::max<size_t>(pixels, 1));
  return sum;
}

}  // namespace wavecrest
