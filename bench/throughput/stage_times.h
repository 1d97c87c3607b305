// CPU time of each stage of a pipeline over whole waves.
//
// A session times its stages by the time-stamp counter, which goes on while another program has the core. Here every
// call is timed in CPU time, at a cost that a render would not want, and that is subtracted again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/render_settings.h"

namespace wavecrest {

struct StageTimes {
  uint64_t paths = 0;
  std::vector<double> seconds;  // per stage, in pipeline order
};

// Traces waves from all over the film until `seconds` have passed, at least one of them. Precision float or fast.
// Nothing for a method with light paths or chains, whose stages need what a session has built before them.
std::optional<StageTimes> measureStageTimes(const Scene& scene, const RenderSettings& settings, double seconds);

}  // namespace wavecrest
