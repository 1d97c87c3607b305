// A few paths by path tracing at places spread over the film, before a render begins: what they find decides how it
// samples, and never what its image is on average.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/film/film_area.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// What counts. weighted: all light, each path by one estimate, as in a render. byChance: light that paths meet by
// chance, whole. unweighted: the same and also, whole, what sampled lights give.
enum class PilotLight { weighted, byChance, unweighted };

// The radiance of each path, by its brightest channel, or 0 where it is not finite: kPilotPaths of them, as many at
// each of `places`, one place after the other. Whatever the settings' method, with random numbers that no render uses,
// and the same ones each time. Depends on the scene and the settings' seed and limits, not on threads or the size of
// waves.
constexpr size_t kPilotPaths = 2048;
template <class S>
std::vector<double> tracePilotPaths(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                                    size_t places, PilotLight light);

}  // namespace wavecrest
