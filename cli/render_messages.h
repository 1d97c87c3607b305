// What `wavecrest render` tells beside its progress: warnings, its memory, its plan and its summary.
#pragma once

#include "cli/progress.h"
#include "cli/render_options.h"
#include "engine/pilot/finished_plan.h"
#include "engine/session/session.h"

namespace wavecrest {

// Of settings that the render cannot follow or that blur the image.
void warnOfLimits(ProgressKind kind, const RenderSettings& settings);
// Before the render: the memory plan, with --memory and for photon maps, whose size depends on the number of light
// paths, and warnings of settings. method: the one that renders, as far as it is known. spreads: the film.
void tellPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, ProgressKind kind,
              Method method, const MemoryPlan& memory, bool spreads);
// One line: which method the trials of `method` (gpt or evcm) have chosen, and the work of each candidate. Prints
// nothing if there were no trials.
void showChoice(ProgressKind kind, Method method, const std::optional<MethodChoice>& choice);
// What --dry-run prints on stdout: scene, kernels, end, memory and outputs of the render.
void showPlan(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, const DryPlan& plan);
// After a render: what the image lacks.
void warnOfLosses(const RenderOptions& options, ProgressKind kind, const RenderSettings& settings,
                  const RenderStatistics& statistics);
// One line with its outputs, its iterations and its speed.
void showSummary(const RenderOptions& options, const RenderSettings& settings, ProgressKind kind,
                 const RenderStatistics& statistics);

}  // namespace wavecrest
