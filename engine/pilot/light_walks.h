// A few light paths before a render begins: how many vertices and splats they leave decides about memory, and about the
// unit of splats.
#pragma once

#include "engine/film/film_area.h"
#include "engine/plan/memory_plan.h"

namespace wavecrest {

// Walks the first light paths of iteration 0, at most kPilotLightPaths. Splats are counted and reach no film. area: its
// list of pixels may be empty.
constexpr size_t kPilotLightPaths = 8192;
template <class S>
LightPilot walkLightPaths(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
