// A render's plan with all that pilots decide: nothing of it changes once a session has it.
#pragma once

#include "engine/film/film_area.h"
#include "engine/plan/memory_plan.h"

namespace wavecrest {

// planRender's plan with its memory, its picks of lights and its limit for the roulette of connections. settings: cut
// by withPieces. Throws std::runtime_error where the method cannot render the scene, MemoryBudgetError where it does
// not fit the settings' budget.
template <class S>
RenderPlan<S> finishedPlan(const Scene& scene, const RenderSettings& settings, const FilmArea& area);

// What a session with these settings will hold. Compiles the scene and walks a few waves of light paths; throws as
// finishedPlan does.
MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings);

}  // namespace wavecrest
