// Renders until the image resembles a reference.
//
// The image is looked at after numbers of iterations that grow by an eighth to a quarter; the render clock stands still
// meanwhile. So a goal is overshot by that much at most.
#pragma once

#include "engine/session.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

struct SsimGoal {
  const PreparedReference& reference;
  double ssim = 0;
};

struct SsimNow {
  uint64_t iterations = 0;  // at the last look
  double ssim = 0;
  bool reached = false;
};

// Goes on to the goal, to the iterations or the time of the settings, or to an interrupt.
SsimNow renderUntilSsim(Session& session, const RenderSettings& settings, const SsimGoal& goal);

}  // namespace wavecrest
