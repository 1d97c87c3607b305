// Camera walks that go on by delta lobes alone, for those who look at what the camera sees.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/plan/render_plan.h"

namespace wavecrest {

// Called with depth 0 once the paths are generated, then at the vertices of each depth, before their delta lobes are
// followed. The walk ends where it returns false.
template <class S>
using ViewLook = std::function<bool(Wave<S>& wave, uint32_t depth)>;

// Traces a path through each pixel (y << 16 | x), by independent random numbers of this seed. cells: of vertices, found
// at each depth; null: none are.
template <class S>
void walkViews(const RenderPlan<S>& plan, const RenderSettings& settings, std::span<const uint32_t> pixels,
               uint64_t seed, const CellTreeView* cells, const ViewLook<S>& look);

}  // namespace wavecrest
