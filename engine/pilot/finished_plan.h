// A render's plan with all that pilots decide: nothing of it changes once a session has it.
#pragma once

#include <memory>
#include <optional>

#include "engine/film/film_area.h"
#include "engine/plan/memory_plan.h"

namespace wavecrest {

// planRender's plan with its memory, its radius of merges, its picks of lights and its limit for the roulette of
// connections. settings: cut by withPieces. Throws std::runtime_error where the method cannot render the scene,
// MemoryBudgetError where it does not fit the settings' budget.
template <class S>
RenderPlan<S> finishedPlan(const Scene& scene, const RenderSettings& settings, const FilmArea& area,
                           std::shared_ptr<const CompiledScene<S>> compiled = nullptr);

// What a session with these settings would be. Nothing of the film's size is allocated.
struct DryPlan {
  Method method{};  // of the settings; pt where trials choose the method and the budget suffices for pt alone
  MemoryPlan memory;
  std::optional<MergeRadius> mergeRadius;  // of methods that merge; of evcm that of the one it chooses, not known here
  Specialization specialization{};
  Isa isa{};
  Accel accel{};
  bool spreads = false;  // camera samples, over the filter's footprint
};
// Compiles the scene and traces a few thousand light paths. Throws what finishedPlan throws.
DryPlan planWithoutSession(const Scene& scene, const RenderSettings& settings);
// Its memory alone.
MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings);

}  // namespace wavecrest
