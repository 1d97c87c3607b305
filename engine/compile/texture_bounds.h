// What is known of a textured colour without a place: its mean and its greatest value.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// The constant, or the mean over the texels of a bitmap or over a checkerboard's two colours. This and the next leave
// out texels of baked attributes that lie outside of their triangles.
Rgb mean(const TexturedRgb& colour, const Scene& scene);

// The constant, or the greatest value of each channel, at least 0.
Rgb greatest(const TexturedRgb& colour, const Scene& scene);

}  // namespace wavecrest
