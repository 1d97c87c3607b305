#include "engine/compile/texture_bounds.h"

#include <algorithm>

#include "engine/scene/texture_mean.h"

namespace wavecrest {
namespace {

Rgb greatest(const Texture& texture) {
  Rgb most{};
  const auto add = [&](size_t channel, double value) { most[channel] = std::max(most[channel], value); };
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    for (size_t i = 0; i < 3; ++i) {
      add(i, checkerboard->color0[i]);
      add(i, checkerboard->color1[i]);
    }
    return most;
  }
  const auto& ofBitmap = std::get<BitmapTexture>(texture.kind);
  const Bitmap& bitmap = *ofBitmap.bitmap;
  const size_t pixels = size_t{bitmap.width} * bitmap.height;
  for (size_t p = 0; p < pixels; ++p) {
    if (isOutside(ofBitmap, p)) continue;
    for (size_t i = 0; i < 3; ++i) add(i, bitmap.pixels[p * bitmap.channels + (bitmap.channels == 3 ? i : 0)]);
  }
  return most;
}

}  // namespace

Rgb mean(const TexturedRgb& colour, const Scene& scene) {
  return colour.texture == kNone ? colour.value : mean(scene.textures[colour.texture]);
}

Rgb greatest(const TexturedRgb& colour, const Scene& scene) {
  return colour.texture == kNone ? colour.value : greatest(scene.textures[colour.texture]);
}

}  // namespace wavecrest
