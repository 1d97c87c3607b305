// Entry points of sky_sampling_entries.cpp: directions towards an environment, as kernels/endpoints/light_lanes.h
// samples them.
#pragma once

#include <array>
#include <cstddef>

#include "kernels/scene_view.h"

namespace wavecrest {

struct SkySamplingEntries {
  // x, y and z of a direction for each four numbers (a, b, c, d). count: a multiple of the lane count.
  void (*sample)(const EnvironmentView& map, const std::array<const float*, 4>& numbers,
                 const std::array<float*, 3>& direction, size_t count);
};

}  // namespace wavecrest
