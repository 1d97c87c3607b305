// The mean of a texture.
#pragma once

#include <algorithm>
#include <cstddef>
#include <variant>

#include "engine/scene/scene.h"

namespace wavecrest {

// Whether no point of a mesh has this texel. The fourth texel of each cell of a baked attribute lies outside of the
// cell's triangle and is extrapolated (engine/load/mesh_attributes.h).
inline bool isOutside(const BitmapTexture& texture, size_t pixel) {
  return texture.attribute != nullptr && pixel % texture.bitmap->width % 2 == 1 &&
         pixel / texture.bitmap->width % 2 == 1;
}

// The mean colour of a bitmap's texels that are not outside, or of a checkerboard's two colours. A bitmap of one
// channel is grey.
inline Rgb mean(const Texture& texture) {
  Rgb sum{};
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    for (size_t i = 0; i < 3; ++i) sum[i] = (checkerboard->color0[i] + checkerboard->color1[i]) / 2;
    return sum;
  }
  const auto& ofBitmap = std::get<BitmapTexture>(texture.kind);
  const Bitmap& bitmap = *ofBitmap.bitmap;
  const size_t pixels = size_t{bitmap.width} * bitmap.height;
  size_t count = 0;
  for (size_t p = 0; p < pixels; ++p) {
    if (isOutside(ofBitmap, p)) continue;
    ++count;
    for (size_t i = 0; i < 3; ++i) sum[i] += bitmap.pixels[p * bitmap.channels + (bitmap.channels == 3 ? i : 0)];
  }
  for (double& channel : sum) channel /= static_cast<double>(std::max<size_t>(count, 1));
  return sum;
}

}  // namespace wavecrest
