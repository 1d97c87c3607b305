// Traces a few light paths before a render. Memory is planned by how many vertices they leave, and the unit of the
// film's integer splats by how bright their splats are.
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
