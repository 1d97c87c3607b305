// How bright a render's pixels typically are, found out by a few paths before it begins.
#pragma once

#include "engine/film/film_area.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// The radiance of a typical pixel, by the brightest of its three channels: the median of places spread over the film,
// so that lamps in view and single bright paths do not count, of those where there is any light. By path tracing,
// whatever the method, with random numbers of its own; 0 where nothing is found. Depends on the scene and the settings'
// seed and limits, not on threads or the size of waves.
template <class S>
double typicalBrightness(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

// StageContext::rouletteBelow of a render: the settings' part of that brightness. 0, so that all connections are
// joined, where the method has no such roulette, and in small scenes, whose shadow rays cost less than it does.
template <class S>
S connectionRouletteLimit(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
