// Renders of all methods whose paths are independent of each other: the schedule of everything but Markov chains.
//
// An iteration has one camera path per pixel. It has as many light paths, with lt up to kMostLightWalks times as many,
// and with a photon map the number that the memory plan says. Without a photon map a wave's light and camera pass
// follow each other and waves are independent; with one, all light passes come first, then the map, then all camera
// passes: phases of a schedule. While the last tasks of a phase run, threads without work begin the light passes of the
// next iteration, as far as there are light stores that no camera pass reads. An iteration with a photon map that has
// begun is finished, even after the time limit: its weights belong to its radius, and its splats share them with its
// camera paths.
//
// Methods without light paths trace several iterations in one wave, which then has fewer pixels: the paths of a pixel
// follow each other and find the same data in the caches. That changes no path and no sum, only their order in time.
//
// Pixels and light paths are cut into pieces whose size follows from their number and the threads', so that small films
// keep all threads busy.
#pragma once

#include <memory>

#include "engine/session/planned_session.h"

namespace wavecrest {

// settings.method must be neither mlt nor evcm. S is the storage type of its precision.
template <class S>
std::unique_ptr<Session> makeWaveSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared = {});

}  // namespace wavecrest
