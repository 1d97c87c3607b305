// Whether runs have missed a score for want of time alone.
#pragma once

#include <optional>
#include <string>

#include "bench/claims/scene_losses.h"

namespace wavecrest {

struct ReachedLater {
  double seconds = 0;     // of a run that reaches the score, by the slope of the loss
  std::string text = {};  // "at this rate 0.9 after 96 s (80 to 120 s)"
};

// Nothing where the slope of the loss is not below 0 by its 95 % interval, where the time is more than 100 times the
// run, which is farther than a slope can be followed, and where it is more than the study had, by its paths per pixel,
// or the runs do not say theirs.
std::optional<ReachedLater> reachedLater(const SceneLosses& scene, const std::string& method, const std::string& metric,
                                         double score);

}  // namespace wavecrest
