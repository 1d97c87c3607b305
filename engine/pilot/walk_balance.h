// How many light walks of light tracing go with each camera walk.
#pragma once

#include <cstdint>

#include "engine/film/film_area.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// More would keep the first whole image away for longer than they are worth.
constexpr uint32_t kMostLightWalks = 4;

// A power of two, at most kMostLightWalks, for a method whose camera walk makes the specular views alone (lt); 1 of any
// other. From the error that either walk leaves in a typical pixel of the area and what it costs in rays, found out by
// a few paths whose random numbers are the same for all seeds, threads and sizes of waves. area: its list of pixels may
// be empty.
template <class S>
uint32_t lightWalksPerCameraWalk(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
