// Camera walks, for those who look at what the camera sees.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/plan/render_plan.h"

namespace wavecrest {

// Called with depth 0 once the paths are generated, then at the vertices of each depth. The walk ends where it returns
// false.
template <class S>
using ViewLook = std::function<bool(Wave<S>& wave, uint32_t depth)>;

// Called where paths have left the vertices of a depth, before they arrive elsewhere: dVCM is the reciprocal of the
// density per solid angle that the direction was sampled with, or 0 of a delta lobe.
template <class S>
using ViewLeft = std::function<void(const Wave<S>& wave)>;

// Traces a path through each pixel (y << 16 | x), by independent random numbers of this seed. cells: of vertices, found
// at each depth; null: none are. left: may be null.
template <class S>
void walkViews(const RenderPlan<S>& plan, const RenderSettings& settings, std::span<const uint32_t> pixels,
               uint64_t seed, const CellTreeView* cells, const ViewLook<S>& look, const ViewLeft<S>& left);

}  // namespace wavecrest
