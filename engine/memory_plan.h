// The memory of a render, before it starts.
//
// in: a plan of the render and the settings. out: what it will hold, item by item, and how many light paths an
// iteration may have so that all of it fits the budget. Light vertices and photons dominate; how many a light path
// leaves is measured on a few waves of light paths, so the plan needs no guess about the scene. Fewer light paths never
// mean that some are left out of the estimate: weights, densities and splats all follow N_L (METHODS 5.1).
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/render_plan.h"

namespace wavecrest {

struct MemoryPlan {
  struct Item {
    std::string_view name;
    uint64_t bytes = 0;
  };
  std::vector<Item> items;
  uint64_t lightPaths = 0;          // N_L, of each iteration
  double verticesPerLightPath = 0;  // stored ones, measured; 0 where a method stores none beyond a wave

  uint64_t total() const;
  // Room for the vertices of so many light paths; iterations and waves differ a little.
  size_t verticesOf(size_t paths) const;
  // One line: the items in MB, their sum, and the light paths where there are any.
  std::string describe() const;
};

// The budget is too small even for the least that a render can do with.
struct MemoryBudgetError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// pixels: of the rendered rectangle. Throws MemoryBudgetError where settings.memoryBytes cannot be kept.
template <class S>
MemoryPlan planMemory(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels);

// The same from a scene, which it compiles.
MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings);

}  // namespace wavecrest
