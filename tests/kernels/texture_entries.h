// Entry points of texture_entries.cpp: textures at points, as kernels/surface/texture_lanes.h evaluates them.
#pragma once

#include <cstddef>

#include "kernels/scene_view.h"

namespace wavecrest {

struct TextureEntries {
  // The first channel and the slopes by u and v of a texture at kMost points or fewer; arrays have kMost elements.
  static constexpr size_t kMost = 16;
  void (*evaluate)(const TextureRecord* textures, const float* texels, uint32_t id, const float* u, const float* v,
                   float* value, float* slopeU, float* slopeV);
};

}  // namespace wavecrest
