// evcm: the method that suits an image, by trials (after Grittmann et al. 2022, Efficiency-aware multiple importance
// sampling for bidirectional rendering algorithms, which weighs the same choices by one method's moments).
//
// The choices of vertex connection and merging are what its paths are for: none of the light's (path tracing), light
// paths that are seen by the camera alone (light tracing), that are connected as well (bidirectional path tracing), or
// that are merged too. Each is a method's page. A small image is rendered by all candidates; those far behind are left
// out, and the others go on. What decides is the variance of a pixel times the work, counted in rays, which is about
// the same at every size of the film.
#pragma once

#include "engine/session/planned_session.h"

namespace wavecrest {

// Compiles the scene, for the trials and the render, and chooses. settings.method must be evcm. The choice depends on
// the scene, the shape of its film and the settings that change a sample, not on the seed, the number of iterations,
// threads, waves or any clock. Throws as Session::create does.
template <class S>
Prepared<S> chooseMethod(const Scene& scene, const RenderSettings& settings);

// The settings by which the chosen method renders.
RenderSettings withMethod(RenderSettings settings, Method method);

}  // namespace wavecrest
