// Whether a campaign has what a claim is about, so that it can be judged at all: light paths, and time by path counts.
#pragma once

#include <string>

#include "bench/claims/claim_list.h"
#include "bench/claims/scene_losses.h"

namespace wavecrest {

// Why the claim cannot be judged on this scene, in some ten words; empty where it can be. Methods that were not
// measured are another matter, since others may refute a claim.
std::string unmetNeed(const Claim& claim, const SceneLosses& scene);

}  // namespace wavecrest
