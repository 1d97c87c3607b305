// Whether a campaign has what a claim is about, so that it can be judged at all: light paths, and time by path counts.
#pragma once

#include <optional>
#include <string>

#include "bench/claims/claim_list.h"
#include "bench/claims/scene_losses.h"

namespace wavecrest {

// Why the claim cannot be judged on this scene, or by a condition's control scene, in some ten words; empty where it
// can be. Methods that were not measured are another matter, since others may refute a claim.
std::string unmetNeed(const Claim& claim, const SceneLosses& scene);

// Camera and light paths per pixel, or mutations, of the method's shortest run, as a share of what the study had time
// for; good to a factor of three (study.h). Nothing where the runs do not say.
std::optional<double> studyPathShare(const SceneLosses& scene, const std::string& method);

// The shares of all methods of the claim: "of the study's paths per pixel: lt 0.2, pt 0.4"; empty where none says.
std::string pathShares(const Claim& claim, const SceneLosses& scene);

}  // namespace wavecrest
