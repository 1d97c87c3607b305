// evcm, and gpt where its guide is left to trials: the method that suits an image (after Grittmann et al. 2022,
// Efficiency-aware multiple importance sampling for bidirectional rendering algorithms, which weighs the choices of
// evcm by one method's moments).
//
// The candidates of evcm are vertex connection and merging and what remains of it without merges (bidirectional path
// tracing), without connections too (light tracing), and without light paths (path tracing); those of gpt are path
// tracing with and without a guide. All of them render a small image.
// After each round, those far behind the best stop. The variance of a pixel times the work, counted in rays, decides;
// it is about the same at every size of the film.
#pragma once

#include <span>

#include "engine/session/planned_session.h"

namespace wavecrest {

// Compiles the scene, for the trials and the render, and chooses. The settings must be areTried(). The choice depends
// on the scene, the shape of its film and the settings that change a sample, not on the seed, the number of iterations,
// threads, waves or any clock. Throws as Session::create does.
template <class S>
Prepared<S> chooseMethod(const Scene& scene, const RenderSettings& settings);

// The most efficient of the trials that were not left out, which have the most iterations. trials: at least one.
const MethodTrial& bestOf(std::span<const MethodTrial> trials);

// The settings by which the chosen method renders; gpt has a guide.
RenderSettings withMethod(RenderSettings settings, Method method);

}  // namespace wavecrest
