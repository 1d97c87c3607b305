// Which survival the settings' roulette gives the walks of a method (METHODS 1.5).
#pragma once

#include <optional>

#include "engine/plan/render_settings.h"
#include "kernels/columns/survival.h"

namespace wavecrest {

// None: by throughput.
std::optional<SurvivalRule> survivalRule(const RenderSettings& settings, Walk walk);

// As a StageContext has it. The rule must outlive the context.
inline const SurvivalRule* pointerTo(const std::optional<SurvivalRule>& rule) { return rule ? &*rule : nullptr; }

}  // namespace wavecrest
