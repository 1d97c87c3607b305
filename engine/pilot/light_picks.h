// How often path tracing picks each emitter, by what each gives to the film.
#pragma once

#include <cstddef>

#include "engine/film/film_area.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

// Of scenes with 2 to so many emitters that are not black, that is; others keep the picks by power.
constexpr size_t kMostWeighedEmitters = 32;

// The power of an emitter says little of what it gives to the places in view: a narrow spot is as bright as a lamp of
// twenty times its power, and a lamp in the next room gives nothing. So a few paths (pilot_paths.h) find out what each
// emitter gives to places on the film, and picks go by its second moment; an eighth of them is even among emitters
// that are not black, so that no image rests on what few paths have seen. Black emitters are never picked. Changes the
// plan's view of its lights.
//
// For methods without light walks. A light walk's choice is another: it is to be picked by what it sends out as well.
template <class S>
void pickLightsByView(RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area);

}  // namespace wavecrest
