// Renders by Markov chains: the schedule of Metropolis light transport.
//
// All chains advance together. An epoch begins with a bootstrap, from whose samples the chains start, and ends after a
// fixed number of steps, when they start anew: a chain that is stuck gets unstuck, and no rule that looks at a chain's
// state can bias the image. A round is a few steps of every wave of chains, in any order on any thread.
#pragma once

#include <memory>

#include "engine/session/session.h"

namespace wavecrest {

// settings.method must be mlt. S is the storage type of its precision.
template <class S>
std::unique_ptr<Session> makeChainSession(const Scene& scene, const RenderSettings& settings);

}  // namespace wavecrest
